"""What can be repaired without asking: findings to edits of the text, comments and layout untouched.

A fix is a proposal: whoever applies one lints again and keeps it only where the finding is gone and no other has come
(`repaired`).
"""

import re
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

from lumen.language.diagnostics import Diagnostic, Place

_BREAK = re.compile("(\r\n|[\n\r\x85\u2028\u2029])")
_MEANT = re.compile(r"did you mean `([^`]+)`\?")
_INSTEAD = re.compile(r"write `(true|false)`|leave out the quotes: (\S+)")
_SAYS = re.compile(r"`([^`]+)`")
_INDENT = re.compile(r"^[ \t]*\t[ \t]*", re.MULTILINE)
_COMMENT = re.compile(r"[ \t]*#[ \t]*lumen:[ \t]*ignore.*")


class Edit(NamedTuple):
    """The text at `place` becomes `text`."""

    place: Place
    text: str


class Fix(NamedTuple):
    """What a fix does, in words, and the edits that do it."""

    title: str
    edits: tuple[Edit, ...]


class Sheet:
    """The text of a file by its lines, as places count them."""

    def __init__(self, file: str, content: bytes) -> None:
        self.file = file
        self.bom = content.startswith(b"\xef\xbb\xbf")
        self.text = content.decode("utf-8-sig", "replace")
        parts = _BREAK.split(self.text)
        self.lines, self.breaks = parts[::2], [*parts[1::2], ""]

    def line(self, number: int) -> str:
        return self.lines[number - 1] if 0 < number <= len(self.lines) else ""

    def at(self, place: Place) -> str:
        """The text at a place of one line, empty where it has several."""
        one = place.line == place.end_line
        return self.line(place.line)[place.column - 1 : place.end_column - 1] if one else ""

    def whole(self, number: int) -> Place:
        """The place of a line with its break."""
        if number < len(self.lines):
            return Place(self.file, number, 1, number + 1, 1)
        return Place(self.file, number, 1, number, len(self.line(number)) + 1)

    def offset(self, line: int, column: int) -> int:
        """Where a place is in the text."""
        before = sum(len(t) + len(b) for t, b in zip(self.lines[: line - 1], self.breaks, strict=False))
        return min(before + column - 1, len(self.text))


def fixes(diagnostic: Diagnostic, files: Mapping[str, bytes]) -> list[Fix]:
    """What may repair this finding, the likeliest first; nothing where only its author can know."""
    content = files.get(diagnostic.place.file)
    fixer = _FIXERS.get(diagnostic.code) or (_word if diagnostic.code.startswith(("unknown-", "wrong-")) else None)
    if content is None or fixer is None:
        return []
    return fixer(diagnostic, Sheet(diagnostic.place.file, content))


def edited(content: bytes, edits: Sequence[Edit]) -> bytes:
    """The file after these edits; of two that overlap the first one counts."""
    sheet = Sheet("", content)
    spans = [(sheet.offset(*e.place[1:3]), sheet.offset(*e.place[3:5]), e.text) for e in dict.fromkeys(edits)]
    text, done = sheet.text, len(sheet.text) + 1
    for start, end, new in sorted(spans, reverse=True):
        if end <= done and not (end == done and start == end):
            text, done = text[:start] + new + text[end:], start
    return (b"\xef\xbb\xbf" if sheet.bom else b"") + text.encode("utf-8", "surrogatepass")


def _word(diagnostic: Diagnostic, sheet: Sheet) -> list[Fix]:
    """The word that was meant, where it is so near that there is no doubt."""
    there = sheet.at(diagnostic.place)
    if instead := _INSTEAD.search(diagnostic.hint):
        new = instead[1] or instead[2]
        return [Fix(f"write {new}", (Edit(diagnostic.place, new),))] if there else []
    meant = _MEANT.search(diagnostic.hint)
    said = [word for word in _SAYS.findall(diagnostic.message) if meant and word != meant[1] and near(word, meant[1])]
    if meant is None or len(said) != 1 or there.count(said[0]) != 1:
        return []
    start = diagnostic.place.column + there.index(said[0])
    spot = diagnostic.place._replace(column=start, end_column=start + len(said[0]))
    return [Fix(f"write {meant[1]}", (Edit(spot, meant[1]),))]


def near(word: str, meant: str) -> bool:
    """Whether one is a slip of the other: another case, a letter too many, too few, wrong, or two exchanged.

    Not where it could be another name: in a short word, in its first letter (`LHand`, `RHand`), in a digit.
    """
    a, b = word.lower(), meant.lower()
    if a == b:
        return True
    short = min(len(a), len(b)) < 4
    if short or a[0] != b[0] or re.findall(r"\d", a) != re.findall(r"\d", b):
        return False
    return _one_slip(a, b)


def _one_slip(a: str, b: str) -> bool:
    i = next((i for i, (x, y) in enumerate(zip(a, b, strict=False)) if x != y), min(len(a), len(b)))
    rest_a, rest_b = a[i:], b[i:]
    return (
        rest_a[1:] == rest_b
        or rest_a == rest_b[1:]
        or rest_a[1:] == rest_b[1:]
        or (rest_a[:2] == rest_b[:2][::-1] and rest_a[2:] == rest_b[2:])
    )


def _tabs(diagnostic: Diagnostic, sheet: Sheet) -> list[Fix]:
    """Tabs in the indentation of the file as two, four or eight spaces each."""
    lines = [(n, m) for n, line in enumerate(sheet.lines, 1) if (m := _INDENT.match(line))]
    return [
        Fix(
            f"write {wide} spaces for each tab",
            tuple(Edit(Place(sheet.file, n, 1, n, m.end() + 1), m[0].replace("\t", " " * wide)) for n, m in lines),
        )
        for wide in (2, 4, 8)
    ]


def _twice(diagnostic: Diagnostic, sheet: Sheet) -> list[Fix]:
    """One of two lines that say the same, the one without a comment where one has one."""
    number = diagnostic.place.line
    line = sheet.line(number)
    if line[: diagnostic.place.column - 1].strip() or _deeper(sheet, number):
        return []
    said = _said(line)
    first = next((n for n in range(number - 1, 0, -1) if _said(sheet.line(n)) == said and not _deeper(sheet, n)), 0)
    if not first:
        return []
    comments = [sheet.line(n)[len(said) :].strip() for n in (first, number)]
    if all(comments) and comments[0] != comments[1]:
        return []
    doomed = first if comments[1] and not comments[0] else number
    return [Fix("delete one of the two", (Edit(sheet.whole(doomed), ""),))]


def _said(line: str) -> str:
    """The line without its comment; of one with a `#` or a quote elsewhere all of it."""
    before = re.split(r"\s+#", line)[0]
    return before.rstrip() if "'" not in before and '"' not in before else line


def _deeper(sheet: Sheet, number: int) -> bool:
    """Whether what is in that line goes on below it."""

    def depth(line: str) -> int:
        return len(line) - len(line.lstrip())

    rest = (line for line in sheet.lines[number:] if line.strip() and not line.lstrip().startswith("#"))
    below = next(rest, "")
    return bool(below) and (depth(below) > depth(sheet.line(number)) or below.lstrip().startswith("- "))


def _comment(diagnostic: Diagnostic, sheet: Sheet) -> list[Fix]:
    """An ignore comment without one of its codes, or without it where it has one."""
    place, line = diagnostic.place, sheet.line(diagnostic.place.line)
    comment = next((m for m in _COMMENT.finditer(line) if m.start() < place.column - 1), None)
    if comment is None:
        return []
    codes = line[line.find("[", comment.start()) + 1 : line.find("]", comment.start())]
    if left := [code for code in re.findall(r"[^,\s]+", codes) if code != sheet.at(place)]:
        start = line.find("[", comment.start()) + 2
        spot = place._replace(column=start, end_column=start + len(codes))
        return [Fix(f"ignore {', '.join(left)} only", (Edit(spot, ", ".join(left)),))]
    if not line[: comment.start()].strip():
        return [Fix("delete the comment", (Edit(sheet.whole(place.line), ""),))]
    spot = place._replace(column=comment.start() + 1, end_column=len(line) + 1)
    return [Fix("delete the comment", (Edit(spot, ""),))]


def _straight(diagnostic: Diagnostic, sheet: Sheet) -> list[Fix]:
    """Straight quotes around a text that has curly ones around it, and no others in it."""
    there = sheet.at(diagnostic.place)
    if len(there) < 2 or there[0] not in "“”„‟" or there[-1] not in "“”‟" or any(c in '"\\' for c in there):
        return []
    return [Fix("write straight quotes", (Edit(diagnostic.place, f'"{there[1:-1]}"'),))]


def _filled(diagnostic: Diagnostic, sheet: Sheet) -> list[Fix]:
    """Two braces on both sides of what is to be filled in."""
    there, said, right = sheet.at(diagnostic.place), _SAYS.search(diagnostic.message), _SAYS.search(diagnostic.hint)
    if said is None or right is None or there.count(said[1]) != 1 or not right[1].startswith("{{"):
        return []
    start = diagnostic.place.column + there.index(said[1])
    spot = diagnostic.place._replace(column=start, end_column=start + len(said[1]))
    return [Fix(f"write {right[1]}", (Edit(spot, right[1]),))]


_FIXERS: Mapping[str, Callable[[Diagnostic, Sheet], list[Fix]]] = {
    "curly-quotes": _straight,
    "duplicate-key": _twice,
    "not-filled-in": _filled,
    "rule-syntax": _word,
    "tab": _tabs,
    "unused-ignore": _comment,
}
"""How to repair what; unknown and wrong words have `_word`."""
