"""Slips of the keyboard and of word processors that keep a file from being YAML, looked for near where it fails."""

import re
from collections.abc import Sequence
from typing import NamedTuple

MAX_LINES_BACK = 3
"""Lines before the one that failed in which the slip may be: YAML notices late."""

_KEY = r"[A-Za-z_][\w.]*"


_KEYED = re.compile(f" *{_KEY}:(?: |$)")
_ITEM = re.compile(r" *- ")


class Slip(NamedTuple):
    """Where (from 1) and how long it is, what it is, and what to write."""

    line: int
    column: int
    length: int
    message: str
    hint: str


_SLIPS = (
    (
        re.compile("^[ ]*(?P<slip>[\u00a0\u2007\u202f\u3000\u200b\ufeff]+)"),
        "this looks like a blank in the indentation, and is another character",
        "delete it, and type spaces",
    ),
    (
        re.compile(f"^ *(?:- )?{_KEY}(?P<slip>：)"),
        "this colon is a wide one, of Chinese or Japanese text",
        "write `:` and a blank",
    ),
    (
        re.compile(f"^ *(?:- )?{_KEY}:(?P<slip>[\u00a0\u2007\u202f\u3000\u200b]+)"),
        "this looks like a blank, and is another character",
        "delete it, and type a space",
    ),
    (
        re.compile("^ *(?P<slip>[–—•*]) +\\w"),
        "an item of a list begins with a hyphen",
        "write `- `",
    ),
    (
        re.compile(f"^ *(?P<slip>-)(?={_KEY}:(?: |$))"),
        "between the hyphen of an item and its text stands a blank",
        "write `- `",
    ),
    (
        re.compile(f"^ *(?:- )?{_KEY}(?P<slip>:)(?=[A-Za-z\"'\\[{{][^ ]*$)(?!//)"),
        "between a colon and its value stands a blank",
        "write `: `",
    ),
    (
        re.compile(f"^ *(?:- )?{_KEY}(?P<slip> ?=) ?(?=[^=>])"),
        "between a key and its value stands a colon",
        "write `: `",
    ),
)


def slip_near(lines: Sequence[str], index: int) -> Slip | None:
    """The slip that is nearest before the line of that index, or in it; None where there is none that is known."""
    for i in range(min(index, len(lines) - 1), max(index - MAX_LINES_BACK, 0) - 1, -1):
        for pattern, message, hint in _SLIPS:
            if found := pattern.search(lines[i]):
                start, end = found.span("slip")
                return Slip(i + 1, start + 1, end - start, message, hint)
    return _odd_item(lines, index)


def _odd_item(lines: Sequence[str], index: int) -> Slip | None:
    """An item among keys, or a key among items, in the line of that index: the line before it tells which."""
    here = lines[index] if index < len(lines) else ""
    above = next((line for line in reversed(lines[:index]) if _indent(line) <= _indent(here) and line.strip()), "")
    column = _indent(here) + 1
    if column != _indent(above) + 1:
        return None
    if _ITEM.match(here) and _KEYED.match(above):
        return Slip(index + 1, column, 1, "an item of a list stands among keys", "delete the `- ` before it")
    if _KEYED.match(here) and _ITEM.match(above):
        hint = "write `- ` before it too, or delete the one above"
        return Slip(index + 1, column, len(here) - column + 1, "a key stands among the items of a list", hint)
    return None


def _indent(line: str) -> int:
    return len(line) - len(line.lstrip(" "))
