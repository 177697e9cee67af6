"""Add members to JSON with comments, such as VS Code's settings, and leave the rest of the text unchanged."""

import json
import re
from typing import Any, NamedTuple

_PIECE = re.compile(r'"(?:[^"\\\n]|\\.)*"|//[^\n]*|/\*.*?\*/|,(?=(?:\s|//[^\n]*|/\*.*?\*/)*[}\]])', re.DOTALL)
_DECODER = json.JSONDecoder()
_BLANKS = " \t\r\n"


class _Item(NamedTuple):
    """A value in the text, as an entry of a map or a list."""

    key: str
    """The value's key in a map; empty in a list."""
    begin: int
    """The offset of the value's first character."""
    end: int
    """The offset behind the value's last character."""


def plain(text: str) -> str:
    """Return the text with comments and trailing commas replaced by spaces, so that all positions stay the same."""
    return _PIECE.sub(lambda found: found[0] if found[0][0] == '"' else re.sub(r"[^\n]", " ", found[0]), text)


def added(text: str, more: dict[str, Any]) -> str:
    """Return the text of a map with these members added; an empty text counts as an empty map.

    A map is merged into an existing map, a list gets the entries that it lacks, and any other value is replaced. Raises
    ValueError if the text is not JSON with comments, or if its top level is not a map.
    """
    data = json.loads(plain(text)) if plain(text).strip() else None
    if data is None:
        return added("{}\n", more) if not text.strip() else added(f"{text.rstrip()}\n{{}}\n", more)
    if not isinstance(data, dict):
        raise ValueError("its top level is not an object")
    for key, value in more.items():
        text = _put(text, len(plain(text)) - len(plain(text).lstrip()), key, value, 1)
    return text


def _put(text: str, begin: int, key: str, value: Any, depth: int) -> str:
    """Return the text with a member added to the map that begins at `begin`, at this depth of indentation."""
    items, close = _items(plain(text), begin)
    old = next((item for item in reversed(items) if item.key == key), None)
    if old is None:
        return _insert(text, items, close, f"{json.dumps(key, ensure_ascii=False)}: {_shown(value, depth)}", depth)
    there = json.loads(plain(text)[old.begin : old.end])
    if isinstance(value, dict) and isinstance(there, dict):
        for inner, each in value.items():
            text = _put(text, old.begin, inner, each, depth + 1)
    elif isinstance(value, list) and isinstance(there, list):
        for each in (each for each in value if each not in there):
            entries, end = _items(plain(text), old.begin)
            text = _insert(text, entries, end, _shown(each, depth + 1), depth + 1)
    elif there != value:
        text = text[: old.begin] + _shown(value, depth) + text[old.end :]
    return text


def _items(blank: str, begin: int) -> tuple[list[_Item], int]:
    """Return the items of the map or list that begins at `begin`, and the position of its closing bracket."""
    found, at = [], _next(blank, begin + 1)
    while blank[at] not in "}]":
        key = ""
        if blank[begin] == "{":
            key, at = _DECODER.raw_decode(blank, at)
            at = _next(blank, _next(blank, at) + 1)
        _, end = _DECODER.raw_decode(blank, at)
        found.append(_Item(key, at, end))
        at = _next(blank, end)
        at = _next(blank, at + 1) if blank[at] == "," else at
    return found, at


def _insert(text: str, items: list[_Item], close: int, row: str, depth: int) -> str:
    """Return the text with a row added before the bracket at `close`, after any comments there."""
    head = text[:close].rstrip(_BLANKS)
    if items and "," not in _commented(text[items[-1].end : close]):
        at = items[-1].end
        head = head[:at] + "," + head[at:]
    return f"{head}\n{'  ' * depth}{row}\n{'  ' * (depth - 1)}{text[close:]}"


def _commented(text: str) -> str:
    """Return the text without its comments."""
    return re.sub(r"//[^\n]*|/\*.*?\*/", "", text, flags=re.DOTALL)


def _next(blank: str, at: int) -> int:
    while blank[at] in _BLANKS:
        at += 1
    return at


def _shown(value: Any, depth: int) -> str:
    return json.dumps(value, indent=2, ensure_ascii=False).replace("\n", f"\n{'  ' * depth}")
