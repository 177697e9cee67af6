"""Workflow commands of GitHub Actions, which become annotations at the lines of a pull request.

The commands and their escapes follow GitHub's documentation of workflow commands, and `command.ts` of its toolkit.
"""

import os
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from lumen.cli.render.concise import render as concise
from lumen.cli.render.terminal_text import clean, counted, summary
from lumen.language.diagnostics import Diagnostic, Severity
from lumen.run.linting.findings import Findings

_COMMANDS: Mapping[Severity, str] = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.INFO: "notice"}

SHOWN = 10
"""The number of findings of each severity that GitHub shows for one step; it drops the rest silently."""


def render(found: Sequence[Findings], *, coloured: bool = False) -> str:
    """Return a command for each finding, with file paths from the repository's root, and a line with the counts.

    GitHub shows the first ten errors, warnings and notices of a step. If there are more, a notice reports that, and all
    findings are in the step's log.
    """
    commands = [_command(each, d) for each in found for d in each.diagnostics]
    return "\n".join([*commands, *_left_out(found), summary(found, False)])


def _left_out(found: Sequence[Findings]) -> Iterator[str]:
    counts = [(sum(each.count(severity) for each in found), command) for severity, command in _COMMANDS.items()]
    more = [counted(number - SHOWN, command) for number, command in counts if number > SHOWN]
    if more:
        said = f"GitHub shows the first {SHOWN} of a kind: {' and '.join(more)} more are only in the log of this step"
        yield f"::notice title=lumen lint::{_escape(said)}"
        yield "::group::All findings"
        yield from concise(found).splitlines()[:-1]
        yield "::endgroup::"


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
