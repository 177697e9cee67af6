"""The exact places of names inside texts, which may be quoted, folded or escaped."""

import re
from collections.abc import Iterator
from functools import lru_cache
from typing import NamedTuple

from lumen.errors import ExpressionError
from lumen.expressions.function_table import functions
from lumen.expressions.tokens import Token, tokenize
from lumen.features.editor.names import NameKind, covers
from lumen.language.diagnostics import NodePath, Place
from lumen.language.text_lines import LineIndex
from lumen.project.document import Document

_TEMPLATE = re.compile(r"\{\{(.*?)\}\}", re.DOTALL)
_NAMED = {"heard": NameKind.PHRASE, "lookup": NameKind.ANSWERS, "In": NameKind.STATE}


class NameInText(NamedTuple):
    """A name within a text, at `offset` characters from the text's beginning."""

    kind: NameKind
    text: str
    offset: int


class DocumentText:
    """The text of a document by offsets and by lines."""

    def __init__(self, document: Document) -> None:
        self.document, self.text = document, document.text
        self._lines = LineIndex(document.text)

    def offset(self, line: int, column: int) -> int:
        """Return the offset of a line and column, from 1; the end of the text if they are beyond it."""
        return self._lines.offset(line, column)

    def part(self, place: Place, source: str, offset: int, length: int) -> Place | None:
        """Return the place of `length` characters from `offset` in `source`, the value of the scalar at `place`.

        Return None if the file contains them in another form.
        """
        start, end = self.offset(place.line, place.column), self.offset(place.end_line, place.end_column)
        raw, word = self.text[start:end], source[offset : offset + length]
        at = raw.find(source)
        if at >= 0:
            return self.between(start + at + offset, length)
        pattern = re.compile(rf"(?<!\w){re.escape(word)}(?!\w)")
        before = sum(1 for found in pattern.finditer(source) if found.start() < offset)
        places = [found.start() for found in pattern.finditer(raw)]
        return self.between(start + places[before], length) if word and before < len(places) else None

    def between(self, start: int, length: int) -> Place:
        """Return the place of `length` characters in one line from the offset `start`."""
        line, column = self._lines.line(start), self._lines.column(start)
        return Place(self.document.file, line, column, line, column + length)

    def scalar(self, path: NodePath, *, key: bool = False) -> Place | None:
        """Return the place of a key or value without its quotes; None if the file contains it in another form."""
        place = self.document.place(path, key=key)
        value = path[-1] if key else self.document.value(path)
        return self.part(place, str(value), 0, len(str(value)))


def key_at(document: Document, line: int, column: int) -> NodePath:
    """Return the path of the key at a line and column, from 1; empty if there is none."""
    found: NodePath = ()
    for path, span in document.spans.items():
        if span.key and covers(span.key, line, column):
            found = path
    return found


def in_expression(source: str, base: int = 0) -> Iterator[NameInText]:
    """Yield the names of context keys, phrases, tables, states and functions in an expression; none if it is invalid.

    `base` is added to each offset.
    """
    yield from (name._replace(offset=base + name.offset) for name in _named(source))


@lru_cache(maxsize=10_000)
def _named(source: str) -> tuple[NameInText, ...]:
    return tuple(_names(source))


def _names(source: str) -> Iterator[NameInText]:
    try:
        tokens = tokenize(source)
    except ExpressionError:
        return
    for i, token in enumerate(tokens):
        if token.text == "context" and _signs(tokens, i + 1, ".") and tokens[i + 2].kind == "name":
            key = tokens[i + 2]
            yield NameInText(NameKind.CONTEXT, key.text, key.offset)
        elif token.kind == "name" and token.text in _NAMED and _signs(tokens, i + 1, "("):
            name = _last_text(tokens, i + 2)
            if name and isinstance(name.value, str):
                yield NameInText(_NAMED[token.text], name.value, name.offset + 1)
        elif token.kind == "name" and _signs(tokens, i + 1, "(") and token.text not in functions():
            yield NameInText(NameKind.FUNCTION, token.text, token.offset)


def in_template(text: str) -> Iterator[NameInText]:
    """Yield the names in the `{{ expressions }}` of a text."""
    for found in _TEMPLATE.finditer(text):
        yield from in_expression(found[1], found.start(1))


def _signs(tokens: list[Token], at: int, sign: str) -> bool:
    return at + 1 < len(tokens) and tokens[at].text == sign


def _last_text(tokens: list[Token], at: int) -> Token | None:
    """Return the text literal that ends a call's arguments, which begin at index `at`; None without one."""
    depth = 1
    while at < len(tokens) and depth:
        depth += (tokens[at].text in ("(", "[", "{")) - (tokens[at].text in (")", "]", "}"))
        at += 1
    last = tokens[at - 2] if at >= 2 else None
    return last if last and last.kind == "text" else None
