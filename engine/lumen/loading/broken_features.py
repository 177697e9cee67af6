"""Findings about features that were installed beside Lumen and can't be used."""

from lumen.distributions import Distribution
from lumen.feature import found
from lumen.language.diagnostics import WARNING, Code, Diagnostic, Place
from lumen.loading.project_folders import MAIN_FILE

BROKEN_FEATURE = Code("broken-feature", "features", WARNING, "an installed feature, or a part of it, can't be used")


def broken_features() -> list[Diagnostic]:
    """Return a finding for each installed distribution whose feature, or a row of it, is ignored."""
    return [broken(fault.distribution, fault.message) for fault in found().faults]


def broken(distribution: Distribution, message: str) -> Diagnostic:
    """Return the finding about one distribution; `message` is the fault."""
    hint = f"update `{distribution.name}`, or remove it: pip uninstall {distribution.name}"
    text = f"the installed package `{distribution.name}` {distribution.version} is faulty: {message}"
    return BROKEN_FEATURE.at(Place(MAIN_FILE), text, hint, cause=distribution.name)
