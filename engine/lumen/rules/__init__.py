"""From a project's files to everything that is wrong with them."""

from collections.abc import Callable, Mapping
from pathlib import Path

from lumen.language.diagnostics import Diagnostic, has_errors
from lumen.language.projects import Project
from lumen.loading.files import read_files
from lumen.loading.packaged import find_project
from lumen.loading.project import assemble, draft
from lumen.rules.checks import CHECKS
from lumen.rules.codes import CODES
from lumen.rules.ignores import obey


def check(path: str | Path | None = None) -> list[Diagnostic]:
    """Everything wrong with the project in that folder, by file and line; never raises for what its files say.

    Raises UsageError where there is no folder.
    """
    root = find_project(path)
    return list(check_files(root, read_files(root))[1])


def check_files(
    root: Path, files: Mapping[str, bytes], between: Callable[[], None] = lambda: None
) -> tuple[Project | None, tuple[Diagnostic, ...]]:
    """The project that these files make, None where they have errors, and everything wrong with them.

    `between` is called between one rule and the next: whoever does not want to know any more raises what they catch.
    """
    found = draft(files)
    found.root = root
    for rule in CHECKS:
        between()
        rule.check(found)
    diagnostics = obey(found.diagnostics, {file: report.document for file, report in found.reports.items()}, CODES)
    project = None if has_errors(diagnostics) else assemble(found, str(root.absolute()))
    return project, diagnostics
