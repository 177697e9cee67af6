"""Fixes of whole lines: indentation, duplicate lines, comments."""

import re

from lumen.language.diagnostics import Diagnostic, Place
from lumen.lint.fixes.edits import Edit, FileText, Fix
from lumen.project.yaml_errors import TAB_WIDTHS, TABBED

_COMMENT = re.compile(r"[ \t]*#[ \t]*lumen:[ \t]*ignore.*")


def spaces(diagnostic: Diagnostic, source: FileText) -> list[Fix]:
    """Return fixes that replace each tab in the indentation with two, four or eight spaces."""
    lines = [(n, m) for n, line in enumerate(source.lines, 1) if (m := TABBED.match(line))]
    return [
        Fix(
            f"write {wide} spaces for each tab",
            tuple(Edit(Place(source.file, n, 1, n, m.end() + 1), m[0].replace("\t", " " * wide)) for n, m in lines),
        )
        for wide in TAB_WIDTHS
    ]


def once(diagnostic: Diagnostic, source: FileText) -> list[Fix]:
    """Return a fix that deletes one of two equal lines; no fix if both have different comments, or inner lines below.

    If only one line has a comment, the other line is deleted.
    """
    number = diagnostic.place.line
    line = source.line(number)
    if line[: diagnostic.place.column - 1].strip() or _deeper(source, number):
        return []
    said = _said(line)
    first = next((n for n in range(number - 1, 0, -1) if _said(source.line(n)) == said and not _deeper(source, n)), 0)
    if not first:
        return []
    comments = [source.line(n)[len(said) :].strip() for n in (first, number)]
    if all(comments) and comments[0] != comments[1]:
        return []
    doomed = first if comments[1] and not comments[0] else number
    return [Fix("delete one of the two", (Edit(source.whole(doomed), ""),))]


def _said(line: str) -> str:
    """Return the line without its comment; the whole line if it has a quote, because a `#` could be part of a text."""
    before = re.split(r"\s+#", line)[0]
    return before.rstrip() if "'" not in before and '"' not in before else line


def _deeper(source: FileText, number: int) -> bool:
    """Return whether the value on line `number`, counted from 1, continues below it."""

    def depth(line: str) -> int:
        return len(line) - len(line.lstrip())

    rest = (line for line in source.lines[number:] if line.strip() and not line.lstrip().startswith("#"))
    below = next(rest, "")
    return bool(below) and (depth(below) > depth(source.line(number)) or below.lstrip().startswith("- "))


def fewer_ignores(diagnostic: Diagnostic, source: FileText) -> list[Fix]:
    """Return a fix that removes one code from an ignore comment, or the whole comment if it has no other code."""
    place, line = diagnostic.place, source.line(diagnostic.place.line)
    comment = next((m for m in _COMMENT.finditer(line) if m.start() < place.column - 1), None)
    if comment is None:
        return []
    codes = line[line.find("[", comment.start()) + 1 : line.find("]", comment.start())]
    if left := [code for code in re.findall(r"[^,\s]+", codes) if code != source.at(place)]:
        start = line.find("[", comment.start()) + 2
        spot = place._replace(column=start, end_column=start + len(codes))
        return [Fix(f"ignore only {', '.join(left)}", (Edit(spot, ", ".join(left)),))]
    if not line[: comment.start()].strip():
        return [Fix("delete the comment", (Edit(source.whole(place.line), ""),))]
    spot = place._replace(column=comment.start() + 1, end_column=len(line) + 1)
    return [Fix("delete the comment", (Edit(spot, ""),))]
