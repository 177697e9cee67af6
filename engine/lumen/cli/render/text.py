"""Diagnostics with the line of the file that each is about, and a mark below the very word."""

import unicodedata
from collections.abc import Iterator, Mapping, Sequence

from lumen.cli.terminal import paint
from lumen.language.diagnostics import Diagnostic, Place, Severity

WIDTH = 160
"""Characters of a line that are shown."""

_COLOURS: Mapping[Severity, str] = {Severity.ERROR: "red", Severity.WARNING: "yellow", Severity.INFO: "blue"}


def render(diagnostics: Sequence[Diagnostic], files: Mapping[str, bytes], *, coloured: bool = False) -> str:
    """Every finding with its place, excerpt and hint, and a line that counts them."""
    texts: dict[str, list[str]] = {}
    blocks = ["\n".join(_finding(d, files, texts, coloured)) for d in diagnostics]
    return "\n\n".join([*blocks, _summary(diagnostics, len(files), coloured)])


def _finding(
    diagnostic: Diagnostic, files: Mapping[str, bytes], texts: dict[str, list[str]], coloured: bool
) -> Iterator[str]:
    place, colour = diagnostic.place, _COLOURS[diagnostic.severity]
    severity = paint(f"{diagnostic.severity}[{diagnostic.code}]", "bold", colour, on=coloured)
    yield f"{paint(_clean(str(place)), 'bold', on=coloured)} {severity} {_clean(diagnostic.message)}"
    yield from _excerpt(place, files, texts, colour, coloured)
    if diagnostic.hint:
        yield f"{' ' * (len(str(place.line)) + 2)}{paint('=', 'dim', on=coloured)} {_clean(diagnostic.hint)}"
    for related in diagnostic.related:
        yield f"  {_clean(str(related.place))} {_clean(related.message)}"


def _excerpt(
    place: Place, files: Mapping[str, bytes], texts: dict[str, list[str]], colour: str, coloured: bool
) -> Iterator[str]:
    if place.file not in texts:
        text = files.get(place.file, b"").decode("utf-8-sig", "replace")
        texts[place.file] = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    lines = texts[place.file]
    if place.line > len(lines) or not lines[place.line - 1].strip():
        return
    line = lines[place.line - 1][:WIDTH]
    end = place.end_column if place.end_line == place.line else len(line.rstrip()) + 1
    before, marked = line[: place.column - 1], line[place.column - 1 : max(end, place.column + 1) - 1]
    gutter = " " * (len(str(place.line)) + 1)
    bar = paint("|", "dim", on=coloured)
    yield f" {place.line} {bar} {_clean(line)}"
    yield f"{gutter} {bar} {' ' * _width(before)}{paint('^' * max(1, _width(marked)), colour, on=coloured)}"


def _summary(diagnostics: Sequence[Diagnostic], files: int, coloured: bool) -> str:
    errors = sum(d.severity is Severity.ERROR for d in diagnostics)
    warnings = sum(d.severity is Severity.WARNING for d in diagnostics)
    what = ", ".join(_count(n, word) for n, word in ((errors, "error"), (warnings, "warning")) if n) or "nothing wrong"
    colour = "red" if errors else "yellow" if warnings else "green"
    return f"{paint(what, 'bold', colour, on=coloured)} in {_count(files, 'file')}"


def _count(number: int, word: str) -> str:
    return f"{number} {word}" if number == 1 else f"{number} {word}s"


def _clean(text: str) -> str:
    """The text with control characters, which could move a terminal's cursor, made visible; a tab is one space."""
    return "".join(" " if c == "\t" else c if c.isprintable() else "\ufffd" for c in text)


def _width(text: str) -> int:
    """Columns that the text takes on a terminal."""
    wide = sum(unicodedata.east_asian_width(c) in "WF" for c in text)
    return len(text) + wide - sum(unicodedata.combining(c) > 0 for c in text)
