"""Workflow commands of GitHub Actions: annotations at the lines of a pull request.

The commands and how they are escaped: GitHub's documentation of workflow commands, and `command.ts` of its toolkit.
"""

import os
from collections.abc import Mapping, Sequence
from pathlib import Path

from lumen.app.lint.findings import Findings
from lumen.cli.render.terminal_text import clean, summary
from lumen.language.diagnostics import Diagnostic, Severity

_COMMANDS: Mapping[Severity, str] = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.INFO: "notice"}


def render(found: Sequence[Findings], *, coloured: bool = False) -> str:
    """A command for each finding, its file as seen from the repository's root, and a line that counts them."""
    return "\n".join([*(_command(each, d) for each in found for d in each.diagnostics), summary(found, False)])


def _command(found: Findings, diagnostic: Diagnostic) -> str:
    place = diagnostic.place
    properties = {
        "title": diagnostic.code,
        "file": _file(found, place.file),
        "line": place.line,
        "endLine": max(place.line, place.end_line),
        "col": place.column,
    }
    if place.end_line == place.line:
        properties["endColumn"] = max(place.column, place.end_column - 1)
    else:
        del properties["col"]  # GitHub refuses columns of several lines
    shown = ",".join(f"{key}={_property(clean(str(value)))}" for key, value in properties.items())
    said = "\n".join(clean(part) for part in (diagnostic.message, diagnostic.hint) if part)
    return f"::{_COMMANDS[diagnostic.severity]} {shown}::{_escape(said)}"


def _file(found: Findings, file: str) -> str:
    if not found.root:
        return file
    workspace = os.environ.get("GITHUB_WORKSPACE") or found.repository
    path = os.path.relpath(os.path.join(os.path.abspath(found.root), file), workspace)
    return Path(path).as_posix()


def _escape(text: str) -> str:
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def _property(text: str) -> str:
    return _escape(text).replace(":", "%3A").replace(",", "%2C")
