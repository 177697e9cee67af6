"""Findings for people, each with its line of the file and the word underlined."""

from collections.abc import Iterator, Sequence

from lumen.cli.render.terminal_text import SEVERITY_COLOURS, clean, summary, width
from lumen.cli.terminal import paint
from lumen.language.diagnostics import Diagnostic, Place
from lumen.language.text_lines import lines_of
from lumen.project.files import Unreadable
from lumen.run.linting.findings import Findings

MAX_EXCERPT_WIDTH = 140
"""The maximum number of characters shown of a line; of a longer line, those around the word are shown."""


def render(found: Sequence[Findings], *, coloured: bool = False) -> str:
    """Return every finding with its place, excerpt, related places and hint, and a line with the counts."""
    blocks = []
    for each in found:
        excerpts = _Excerpts(each, coloured)
        blocks += ["\n".join(_finding(d, excerpts)) for d in each.diagnostics]
    return "\n\n".join([*blocks, summary(found, coloured) + _more(found)])


def _more(found: Sequence[Findings]) -> str:
    """Return a line that suggests `lumen explain`; empty if there are no findings."""
    codes = [d.code for each in found for d in each.diagnostics]
    if not codes:
        return ""
    return f"\nFor more: `lumen explain {codes[0]}`{', and likewise for every code in brackets' if codes[1:] else ''}"


def _finding(diagnostic: Diagnostic, excerpts: "_Excerpts") -> Iterator[str]:
    place, colour, on = diagnostic.place, SEVERITY_COLOURS[diagnostic.severity], excerpts.coloured
    severity = paint(f"{diagnostic.severity}[{diagnostic.code}]", "bold", colour, on=on)
    yield f"{excerpts.where(place)} {severity} {clean(diagnostic.message)}"
    gutter = max(len(str(p.line)) for p in (place, *(r.place for r in diagnostic.related)))
    yield from excerpts.of(place, gutter, "^", colour)
    if diagnostic.hint:
        yield f" {' ' * gutter} {paint('=', 'dim', on=on)} {clean(diagnostic.hint)}"
    seen = {place[:2]}
    for related in diagnostic.related:
        yield f"  {excerpts.where(related.place)} {clean(related.message)}"
        if related.place[:2] not in seen:
            yield from excerpts.of(related.place, gutter, "-", "blue")
        seen.add(related.place[:2])


class _Excerpts:
    """Lines of a project's files, with a mark below the words of a place."""

    def __init__(self, found: Findings, coloured: bool) -> None:
        self.found, self.coloured = found, coloured
        self.texts: dict[str, list[str]] = {}

    def where(self, place: Place) -> str:
        """Return the place in the form `file:line:column`, which many terminals make a link."""
        name = f"{clean(self.found.name(place.file))}:{place.line}:{place.column}"
        return paint(name, "bold", on=self.coloured)

    def of(self, place: Place, gutter: int, sign: str, colour: str) -> Iterator[str]:
        """Yield the line of a place and the mark below it; nothing if the line is blank or does not exist."""
        lines = self.lines(place.file)
        if place.line > len(lines) or not lines[place.line - 1].strip():
            return
        line, start, end = _cut(lines[place.line - 1], place)
        marked = sign * max(1, width(line[start:end]))
        bar = paint("|", "dim", on=self.coloured)
        yield f" {place.line:>{gutter}} {bar} {clean(line)}"
        yield f" {' ' * gutter} {bar} {' ' * width(line[:start])}{paint(marked, colour, on=self.coloured)}"

    def lines(self, file: str) -> list[str]:
        if file not in self.texts:
            content = self.found.files.get(file, b"")
            shown = b"" if isinstance(content, Unreadable) else content
            self.texts[file] = lines_of(shown.decode("utf-8-sig", "replace"))
        return self.texts[file]


def _cut(line: str, place: Place) -> tuple[str, int, int]:
    """Return at most MAX_EXCERPT_WIDTH characters of the line, and where the place begins and ends in them."""
    start = min(place.column - 1, len(line))
    end = place.end_column - 1 if place.end_line == place.line else len(line.rstrip())
    if len(line) <= MAX_EXCERPT_WIDTH:
        return line, start, max(end, start + 1)
    first = max(0, min(start - MAX_EXCERPT_WIDTH // 3, len(line) - MAX_EXCERPT_WIDTH))
    shown = (
        ("…" if first else "")
        + line[first : first + MAX_EXCERPT_WIDTH]
        + ("…" if first + MAX_EXCERPT_WIDTH < len(line) else "")
    )
    offset = first - (1 if first else 0)
    return shown, start - offset, max(min(end, first + MAX_EXCERPT_WIDTH) - offset, start - offset + 1)
