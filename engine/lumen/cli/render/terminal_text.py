"""Functions that several formats of findings share."""

import unicodedata
from collections.abc import Mapping, Sequence

from lumen.cli.terminal import paint
from lumen.language.diagnostics import Severity
from lumen.run.linting.findings import Findings

SEVERITY_COLOURS: Mapping[Severity, str] = {Severity.ERROR: "red", Severity.WARNING: "yellow", Severity.INFO: "blue"}


def summary(found: Sequence[Findings], coloured: bool) -> str:
    """Return a line with the number of findings by severity, of files with findings, and of files checked."""
    counts = [(sum(each.count(severity) for each in found), severity) for severity in Severity]
    files = {(each.root, d.place.file) for each in found for d in each.diagnostics}
    what = ", ".join(counted(n, {"info": "note"}.get(severity, severity)) for n, severity in counts if n)
    colour = next((SEVERITY_COLOURS[severity] for n, severity in counts if n), "green")
    where = f" in {counted(len(files), 'file')}" if files else ""
    return f"{paint((what or 'nothing wrong') + where, 'bold', colour, on=coloured)}; {_looked_at(found)}"


def _looked_at(found: Sequence[Findings]) -> str:
    checked = f"{counted(sum(len(each.files) for each in found), 'file')} checked"
    if len(found) > 1:
        checked += f" in {counted(len(found), 'project')}"
    elif found and found[0].root and found[0].name("") not in (".", "./"):
        checked += f" in {clean(found[0].name('').rstrip('/') or '/')}"
    elsewhere = sum(each.elsewhere for each in found)
    return f"{checked}, {counted(elsewhere, 'finding')} in other files" if elsewhere else checked


def counted(number: int, word: str) -> str:
    """Return a number with its noun: `1 file`, `2 files`."""
    return f"{number:,} {word}" if number == 1 else f"{number:,} {word}s"


def clean(text: str) -> str:
    """Return the text with tabs as spaces, and control characters, which could move the cursor, made visible."""
    return "".join(" " if c == "\t" else c if c.isprintable() else "\ufffd" for c in text)


def width(text: str) -> int:
    """Return the number of columns that a text occupies on a terminal."""
    wide = sum(unicodedata.east_asian_width(c) in "WF" for c in text)
    return len(text) + wide - sum(unicodedata.combining(c) > 0 for c in text)
