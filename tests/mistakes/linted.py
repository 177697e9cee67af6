"""Lint's findings in a project, computed once in a process: two tests read the same 301 rows."""

from collections.abc import Mapping
from pathlib import Path

from lumen.language.diagnostics import Diagnostic
from lumen.lint import check_files

_found: dict[tuple[Path, frozenset[tuple[str, bytes]]], tuple[Diagnostic, ...]] = {}


def findings(root: Path, files: Mapping[str, bytes]) -> tuple[Diagnostic, ...]:
    """Return lint's findings in these files, in its order."""
    key = root, frozenset(files.items())
    if key not in _found:
        _found[key] = check_files(root, files)[1]
    return _found[key]
