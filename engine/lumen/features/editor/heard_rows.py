"""The keys of `hears`, such as `not dance|sing`, `question.right` and `else`, and the row around a node."""

import re
from collections.abc import Iterator
from typing import Any

from lumen.language.diagnostics import NodePath
from lumen.project.words import ANYHOW

WAYS = ("not", "asked")
ELSE = "else"
_WORD = re.compile(r"[^\s|]+")


def names_in(key: str) -> Iterator[tuple[str, int]]:
    """Yield the names of phrases and answers in a key with their offsets; skip a lone `else` and `ENTRY.FIELD`."""
    found = [(word[0], word.start()) for word in _WORD.finditer(key)]
    if len(found) > 1 and found[0][0] in WAYS:
        found = found[1:]
    yield from ((name, offset) for name, offset in found if "." not in name and (name, len(found)) != (ELSE, 1))


def row_around(path: NodePath) -> str:
    """Return the key of the row of `hears` that contains a node; empty if there is none."""
    at = next((i for i in reversed(range(len(path) - 2)) if path[i] == "hears"), None)
    return "" if at is None else str(path[at + 1])


def is_phrase(kind: str, path: NodePath) -> bool:
    """Return True if the text at a path, in a file of that kind, is a phrase in `phrases` or in a row of `answers`."""
    if kind not in ("behavior", "words"):
        return False
    steps = tuple(step for step in path if isinstance(step, str))
    return (steps[:1] == ("phrases",) and len(steps) in (2, 3)) or (
        steps[:1] == ("answers",) and steps[2:3] == ("phrases",) and len(steps) in (3, 4)
    )


def texts_in(data: Any) -> Iterator[str]:
    """Yield the phrases in the data of a name, in all languages or in all rows of an answers table."""
    match data:
        case str():
            yield data
        case list():
            yield from (text for item in data for text in texts_in(item))
        case dict():
            inside = [data["phrases"]] if "phrases" in data else [v for key, v in data.items() if key != ANYHOW]
            yield from (text for item in inside for text in texts_in(item))
