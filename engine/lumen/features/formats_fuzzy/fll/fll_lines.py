"""The lines of a file in FuzzyLite Language: `key: value`; `#` begins a comment, and a head begins each part."""

from collections.abc import Iterator
from typing import NamedTuple

from lumen.language.diagnostics import Place
from lumen.language.text_lines import lines_of
from lumen.project.formats.conversion_findings import ConversionFindings, broken

MAX_FLL_LINES = 20_000
"""The most lines of a file."""

PART_KEYS = ("Engine", "InputVariable", "OutputVariable", "RuleBlock")
"""The keys that begin a part."""


class FllLine(NamedTuple):
    """A line `key: value` with its places; `offset` is the value's first column from 0."""

    key: str
    value: str
    row: int
    column: int
    offset: int


class FllPart(NamedTuple):
    """An engine's head, a variable or a block: its first line, and the others."""

    head: FllLine
    lines: list[FllLine]


class FllLineReader:
    """Reads one file by its lines, and reports what can't be converted."""

    def __init__(self, file: str, findings: ConversionFindings) -> None:
        self.file, self.findings = file, findings

    def parts(self, text: str) -> Iterator[FllPart]:
        """Yield the parts of a text; report lines before the first."""
        part: FllPart | None = None
        for line in self.lines(text):
            if line.key in PART_KEYS:
                if part:
                    yield part
                part = FllPart(line, [])
            elif part:
                part.lines.append(line)
            else:
                self.lost(line, f"`{line.key}` is before `Engine:`")
        if part:
            yield part

    def lines(self, text: str) -> Iterator[FllLine]:
        """Yield the lines of a text; report invalid ones. Raises ForeignFileError for too many."""
        rows = lines_of(text)
        if len(rows) > MAX_FLL_LINES:
            raise broken(Place(self.file), "too-large", f"the file has more than {MAX_FLL_LINES:,} lines", "split it")
        for row, source in enumerate(rows, 1):
            said = source.partition("#")[0].rstrip()
            if not said.strip():
                continue
            column = len(said) - len(said.lstrip())
            key, colon, value = said.partition(":")
            offset = len(key) + 1 + len(value) - len(value.lstrip())
            line = FllLine(key.strip(), value.strip(), row, column, offset)
            if colon:
                yield line
            else:
                self.lost(line, "this line can't be read: write `key: value`")

    def place(self, line: FllLine, offset: int | None = None, length: int | None = None) -> Place:
        """Return the place of the line's value, or of a part of it."""
        begin = line.offset + 1 + (offset or 0) if line.value else line.column + 1
        width = length or max(len(line.value) - (offset or 0), 1) if line.value else max(len(line.key), 1)
        return Place(self.file, line.row, begin, line.row, begin + width)

    def lost(self, line: FllLine, message: str, hint: str = "") -> None:
        """Report a line that could not be converted."""
        self.findings.lost(self.place(line), message, hint)
