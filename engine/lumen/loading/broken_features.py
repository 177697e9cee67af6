"""Findings about features that were installed beside Lumen and can't be used."""

from traceback import walk_tb
from typing import Any

from lumen.distributions import Distribution, distributions
from lumen.errors import LumenError, UsageError
from lumen.feature import Feature, FeatureFault, distribution_of, found, resolve
from lumen.language.diagnostics import WARNING, Code, Diagnostic, Place
from lumen.loading.packaged import PACKAGE
from lumen.loading.project_folders import MAIN_FILE

BROKEN_FEATURE = Code("broken-feature", "features", WARNING, "an installed feature, or a part of it, can't be used")


def broken_features() -> list[Diagnostic]:
    """Return a finding for each installed distribution whose feature, or a row of it, is ignored."""
    from lumen.interpreters.added_verbs import faulty_verbs  # and with it all of the expressions

    verbs = ((distribution_of(feature), fault) for feature, fault in faulty_verbs())
    faults = [*found().faults, *(FeatureFault(distribution, fault) for distribution, fault in verbs if distribution)]
    return [broken(fault.distribution, fault.message) for fault in faults]


def broken(distribution: Distribution, message: str) -> Diagnostic:
    """Return the finding about one distribution; `message` is the fault."""
    hint = f"update `{distribution.name}`, or remove it: pip uninstall {distribution.name}"
    text = f"the installed package `{distribution.name}` {distribution.version} is faulty: {message}"
    return BROKEN_FEATURE.at(Place(MAIN_FILE), text, hint, cause=distribution.name)


def resolved(feature: Feature, where: str) -> Any:
    """Return what an import string of a feature names.

    Raises LumenError with the name of the distribution if a feature is faulty that was installed beside Lumen.
    """
    try:
        return resolve(where)
    except Exception as error:
        raise blamed(feature, where, error) from error


def called(feature: Feature, where: str, *arguments: Any, **named: Any) -> Any:
    """Return what the function of an import string of a feature returns.

    Raises LumenError as that function does, or with the name of the distribution if a feature is faulty that was
    installed beside Lumen.
    """
    function = resolved(feature, where)
    try:
        return function(*arguments, **named)
    except LumenError:
        raise
    except Exception as error:
        raise blamed(feature, where, error) from error


def blamed(feature: Feature, where: str, error: Exception) -> LumenError:
    """Return an error that names the distribution in whose module `error` was raised.

    Raises `error` itself if the feature comes with Lumen.
    """
    if distribution_of(feature) is None:
        raise error
    return faulty(feature, f"its module `{where}` raised {type(error).__name__}: {error}")


def faulty(feature: Feature, message: str) -> LumenError:
    """Return an error about a fault of a feature; it names the distribution, if the feature was installed with one."""
    distribution = distribution_of(feature)
    if distribution is None:
        return LumenError(f"the feature `{feature.name}` is faulty: {message}")
    finding = broken(distribution, message)
    return LumenError(f"{finding.message} ({finding.hint})")


def fault_of_package(error: BaseException) -> str:
    """Return the fault that ended the program, if code of a package that was installed beside Lumen raised it.

    The innermost call of Lumen's code or of a package's decides; the text is empty if that is Lumen's.
    """
    packages = {package: each for each in distributions() for package in each.packages}
    calls = [(frame.f_globals.get("__name__", ""), line) for frame, line in walk_tb(error.__traceback__)]
    for module, line in reversed(calls):
        package = module.partition(".")[0]
        if package == PACKAGE.name:
            return ""
        if package in packages:
            what = f"line {line} of `{module}` raised {type(error).__name__}: {error}"
            finding = broken(packages[package], what)
            return f"{finding.message} ({finding.hint})"
    return ""


def need_made(feature: Feature, where: str, value: Any, kind: type, what: str) -> None:
    """Raise LumenError if what an import string made lacks a method of a protocol."""
    from lumen.interpreters.arguments import need_methods  # kept findings need no interpreters

    try:
        need_methods(value, kind, what)
    except UsageError as error:
        raise faulty(feature, f"`{where}` made a wrong object: {error}") from None
