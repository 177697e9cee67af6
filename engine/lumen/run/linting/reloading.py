"""Findings about values and states that a reload of a project would refuse, move or forget."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from lumen.language.diagnostics import Diagnostic
from lumen.lint import check_files
from lumen.run.linting.findings import Findings
from lumen.run.reload.against import against
from lumen.run.versions import version


def compared(found: Findings, name: str, wanted: Callable[[Diagnostic], bool]) -> Findings:
    """Return the findings, plus those of a reload from the version `name` if the project has no errors."""
    root = Path(found.root)
    old, new = version(name, root).project, check_files(root, found.files)[0]
    more = [d for d in against(old, new) if wanted(d)] if new else []
    shown = [d for d in more if not found.asked or d.place.file in found.asked]
    elsewhere = found.elsewhere + len(more) - len(shown)
    return replace(found, diagnostics=[*found.diagnostics, *shown], elsewhere=elsewhere)
