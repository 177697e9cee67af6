"""Splits a file in FuzzyLite Language into parts and their lines, `key: value`; `#` begins a comment."""

from collections.abc import Iterator
from typing import NamedTuple

from lumen.language.diagnostics import Place
from lumen.language.text_lines import lines_of
from lumen.project.formats.conversion_findings import ConversionFindings, broken

MAX_FLL_LINES = 20_000
"""The most lines in a file."""

PART_KEYS = ("Engine", "InputVariable", "OutputVariable", "RuleBlock")
"""The keys that begin a part."""


class FllLine(NamedTuple):
    """A line `key: value`; `row` counts from 1, `column` (of the key) and `offset` (of the value) from 0."""

    key: str
    value: str
    row: int
    column: int
    offset: int


class FllPart(NamedTuple):
    """An engine's head, a variable or a rule block: its first line, and the lines after it."""

    head: FllLine
    lines: list[FllLine]


class FllLineReader:
    """Splits one file into parts and lines, and reports lines that can't be converted."""

    def __init__(self, file: str, findings: ConversionFindings) -> None:
        self.file, self.findings = file, findings

    def parts(self, text: str) -> Iterator[FllPart]:
        """Yield a text's parts; report lines before the first part."""
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
        """Yield a text's lines that are not empty; report invalid ones. Raises ForeignFileError for too many lines."""
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
        """Return the place of the line's value or a part of it; of the key if the value is empty."""
        begin = line.offset + 1 + (offset or 0) if line.value else line.column + 1
        width = length or max(len(line.value) - (offset or 0), 1) if line.value else max(len(line.key), 1)
        return Place(self.file, line.row, begin, line.row, begin + width)

    def lost(self, line: FllLine, message: str, hint: str = "") -> None:
        """Report a line that could not be converted."""
        self.findings.lost(self.place(line), message, hint)
