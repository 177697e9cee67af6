"""Fixes of a word or a text whose right form is in the finding's message or hint."""

import re
from collections.abc import Mapping

from lumen.language.diagnostics import Diagnostic
from lumen.lint.fixes.edits import Edit, FileText, Fix

_MEANT = re.compile(r"did you mean `([^`]+)`\?")
_INSTEAD = re.compile(r"write `(true|false)`|leave out the quotes: (\S+)")
_SAYS = re.compile(r"`([^`]+)`")


def slip(diagnostic: Diagnostic, source: FileText) -> list[Fix]:
    """Return the fix that writes the word from the hint; no fix if the word is not similar enough to be certain."""
    there = source.at(diagnostic.place)
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


def outnumbered(word: str, meant: str, files: Mapping[str, bytes]) -> bool:
    """Return whether the project uses `word` several times, and `meant` at most as often.

    Then the slip is probably in the single definition, not in its uses.
    """
    often, seldom = _count(word, files), _count(meant, files)
    return often > 1 and often >= seldom


def _count(word: str, files: Mapping[str, bytes]) -> int:
    whole = re.compile(rb"(?<!\w)" + re.escape(word.encode("utf-8", "surrogatepass")) + rb"(?!\w)")
    return sum(len(whole.findall(content)) for content in files.values())


def near(word: str, meant: str) -> bool:
    """Return whether two words differ by one slip: case, one letter added, missing or wrong, or two letters exchanged.

    Return False if they could be two different names: short words, words with different first letters or digits.
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


def straight_quotes(diagnostic: Diagnostic, source: FileText) -> list[Fix]:
    """Return a fix that makes the quotes around a text straight; no fix if the text contains quotes or backslashes."""
    there = source.at(diagnostic.place)
    if len(there) < 2 or there[0] not in "“”„‟" or there[-1] not in "“”‟" or any(c in '"\\' for c in there):
        return []
    return [Fix("write straight quotes", (Edit(diagnostic.place, f'"{there[1:-1]}"'),))]


def point(diagnostic: Diagnostic, source: FileText) -> list[Fix]:
    """Return a fix that writes a number with a point instead of its comma; no fix if it has several commas."""
    there = source.at(diagnostic.place)
    return [Fix("write a point", (Edit(diagnostic.place, there.replace(",", ".")),))] if there.count(",") == 1 else []


def filled_in(diagnostic: Diagnostic, source: FileText) -> list[Fix]:
    """Return a fix that writes double braces around a placeholder; no fix if its place in the text is not certain."""
    there, said, right = source.at(diagnostic.place), _SAYS.search(diagnostic.message), _SAYS.search(diagnostic.hint)
    if said is None or right is None or there.count(said[1]) != 1 or not right[1].startswith("{{"):
        return []
    start = diagnostic.place.column + there.index(said[1])
    spot = diagnostic.place._replace(column=start, end_column=start + len(said[1]))
    return [Fix(f"write {right[1]}", (Edit(spot, right[1]),))]
