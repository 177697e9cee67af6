"""Phrases as patterns: `(a|b)`, `[optional]`, `{TYPE}` or `{TYPE:SLOT}`, and a full stop for a whole clause.

A pattern is expanded into its forms when it is read; a phrase that is not a valid pattern counts as its plain words.
The signs are those of JSGF and of Home Assistant's `hassil`.
"""

import re
from collections.abc import Iterator
from functools import lru_cache
from itertools import product
from typing import NamedTuple

from lumen.talk.folding import folded

MAX_FORMS = 200
"""The greatest number of forms of a pattern; a pattern with more forms is not valid."""

_SLOT = re.compile(r"\{([A-Za-z_]\w*\??)(?::([A-Za-z_]\w*))?\}")
_SIGNS = re.compile(r"[()\[\]{}|]")
TYPES = ("name", "name?", "number", "text")
"""The types of slots that are not lists."""


class Slot(NamedTuple):
    """A slot of a form."""

    type: str
    """One of TYPES, or the name of a list."""
    name: str
    """The key in `heard`."""
    language: str = ""
    """The language of the phrase; empty until it is known."""


class Form(NamedTuple):
    """A form of a phrase: folded words and slots in order; `whole` is true if the form must be a whole clause."""

    parts: tuple[str | Slot, ...]
    whole: bool

    @property
    def literals(self) -> tuple[str, ...]:
        return tuple(part for part in self.parts if isinstance(part, str))

    @property
    def plain(self) -> bool:
        """Whether the form has no slots."""
        return all(isinstance(part, str) for part in self.parts)


class PatternError(ValueError):
    """A phrase that can't be read as a pattern; `offset` and `length` locate the characters."""

    def __init__(self, message: str, hint: str, offset: int, length: int = 1) -> None:
        super().__init__(message)
        self.message, self.hint, self.offset, self.length = message, hint, offset, length


@lru_cache(maxsize=8192)
def forms(phrase: str) -> tuple[Form, ...]:
    """Return the forms of a phrase, in the order written; the form of its plain words if it is not a valid pattern."""
    try:
        return read_pattern(phrase)
    except PatternError:
        return _formed([phrase], [], phrase)


@lru_cache(maxsize=8192)
def read_pattern(phrase: str) -> tuple[Form, ...]:
    """Return the forms of a phrase. Raises PatternError if it is not a valid pattern."""
    return _formed(*_expanded(phrase), phrase)


def written_forms(phrase: str) -> Iterator[tuple[str | Slot, ...]]:
    """Yield the forms of a phrase as written, texts and slots in order; the phrase itself if it is no valid pattern."""
    try:
        texts, slots = _expanded(phrase)
    except PatternError:
        texts, slots = [phrase], []
    for text in dict.fromkeys(texts):
        pieces = text.split("\0")
        yield tuple(slots[int(piece)] if i % 2 else " ".join(piece.split()) for i, piece in enumerate(pieces))


def _expanded(phrase: str) -> tuple[list[str], list[Slot]]:
    """Return the texts of the forms of a phrase, each slot as `\\0number\\0`, and the slots."""
    if not _SIGNS.search(phrase):
        return [phrase], []
    reader = _Reader(phrase)
    return reader.read(), reader.slots


def _formed(texts: list[str], slots: list[Slot], phrase: str) -> tuple[Form, ...]:
    whole = phrase.rstrip().endswith(".")
    found: dict[Form, None] = {}
    for text in texts:
        parts: list[str | Slot] = []
        for i, piece in enumerate(text.split("\0")):
            parts += [slots[int(piece)]] if i % 2 else folded(piece)
        if parts:
            found[Form(tuple(parts), whole)] = None
    return tuple(found)


class _Reader:
    """Reads one pattern into the texts of its forms, in which `\\0number\\0` marks a slot."""

    def __init__(self, phrase: str) -> None:
        self.phrase, self.position = phrase, 0
        self.slots: list[Slot] = []

    def read(self) -> list[str]:
        found = self.sequence("")
        if self.position < len(self.phrase):
            sign = self.phrase[self.position]
            if sign == "|":
                hint = f"write ({self.phrase.strip()}), or each alternative in a line of its own"
                raise PatternError("`|` is allowed only inside ( ) or [ ], between alternatives", hint, self.position)
            raise PatternError(
                f"`{sign}` closes nothing", f"remove it, or add its opening bracket: {_OPENS[sign]}", self.position
            )
        return found

    def sequence(self, closing: str) -> list[str]:
        """Return the texts of the forms up to a closing bracket or a `|`, which is not read.

        Raises PatternError if there are more than `MAX_FORMS`.
        """
        found = [""]
        while self.position < len(self.phrase) and (sign := self.phrase[self.position]) not in ")]}|":
            more = self.group() if sign in "([" else [self.slot() if sign == "{" else self.plain()]
            if len(found) * len(more) > MAX_FORMS:
                message = f"this phrase has more than {MAX_FORMS} forms"
                raise PatternError(message, "write several phrases instead", 0, len(self.phrase))
            found = [a + b for a, b in product(found, more)]
        return found

    def plain(self) -> str:
        start = self.position
        end = _SIGNS.search(self.phrase, start)
        self.position = end.start() if end else len(self.phrase)
        return self.phrase[start : self.position]

    def group(self) -> list[str]:
        start, sign = self.position, self.phrase[self.position]
        closing = _CLOSES[sign]
        found: list[str] = [""] if sign == "[" else []
        while True:
            self.position += 1
            inside = self.sequence(closing)
            if inside == [""]:
                written = self.phrase[start : self.position + 1]
                raise PatternError(f"an alternative of `{written}` is empty", _EMPTY, start, len(written))
            found += inside
            ended = self.phrase[self.position : self.position + 1]
            if ended == closing:
                self.position += 1
                return found
            if ended != "|":
                message = f"`{sign}` is not closed"
                raise PatternError(message, f"add `{closing}` after the last alternative", start)

    def slot(self) -> str:
        start = self.position
        found = _SLOT.match(self.phrase, start)
        if found is None:
            end = self.phrase.find("}", start)
            length = (end + 1 if end >= 0 else len(self.phrase)) - start
            message = f"`{self.phrase[start : start + length]}` is not a slot"
            hint = "write {TYPE} or {TYPE:SLOT} without a space, such as {name} or {number:n}"
            raise PatternError(message, hint, start, length)
        self.position = found.end()
        kind, name = found[1], found[2] or found[1].rstrip("?")
        self.slots.append(Slot(kind, name))
        return f" \0{len(self.slots) - 1}\0 "


_CLOSES = {"(": ")", "[": "]"}
_OPENS = {")": "(", "]": "[", "}": "{"}
_EMPTY = "remove the empty alternative; put an optional part in [ ]"


@lru_cache(maxsize=8192)
def slots_of(phrase: str) -> tuple[Slot, ...]:
    """Return the slots of a phrase, each once."""
    if "{" not in phrase:
        return ()
    return tuple(dict.fromkeys(part for form in forms(phrase) for part in form.parts if isinstance(part, Slot)))
