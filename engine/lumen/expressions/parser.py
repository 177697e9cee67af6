"""Parses the text of an expression to its tree."""

from collections.abc import Collection
from functools import lru_cache
from typing import ClassVar

from lumen.errors import ExpressionError
from lumen.expressions.pratt import PrattParser
from lumen.expressions.scope import MAX_INT, MAX_TREE_DEPTH, MIN_INT
from lumen.expressions.tokens import Token, tokenize
from lumen.expressions.tree import ExpressionNode, Literal

_HINTS = {
    "and": "write `&&`", "or": "write `||`", "not": "write `!`", "is": "compare with `==`", "None": "write `null`",
    "True": "write `true`", "False": "write `false`", "if": "write `condition ? then : otherwise`",
}  # fmt: skip
_PAIRS = {
    "**": "there is no operator for powers: multiply",
    "//": "to divide, write `/`; an expression can't contain comments",
    "<>": "write `!=`", "=>": "write `>=`", "=<": "write `<=`", "++": "to change a value, use `assign`",
    "??": "write `has(…) ? … : …`", "?.": "check with `has(…)` first",
}  # fmt: skip
"""Operators of other languages that are two tokens here, each with a hint."""


MAX_REMEMBERED_TREES = 10_000


@lru_cache(maxsize=MAX_REMEMBERED_TREES)
def parse_expression(source: str) -> ExpressionNode:
    """Return the tree of an expression; raise ExpressionError with the offset of an invalid part.

    Trees are frozen, and equal sources share one tree.
    """
    return _ExpressionParser(tokenize(source)).bounded()


class _ExpressionParser(PrattParser):
    reserved = frozenset((*_HINTS, "in"))
    max_levels = 2 * MAX_TREE_DEPTH

    def unexpected(self, hint: str = "") -> ExpressionError:
        """Return the error for a token that is not allowed at its place."""
        token = self.token
        if token.kind == "end":
            what = "the expression ends too early" if self.position else "there is no expression"
            return ExpressionError(what, token.offset, hint)
        hint = _PAIRS.get(self._pair(), _HINTS.get(token.text, hint))
        return ExpressionError(f"`{token.text[:40]}` is not allowed here", token.offset, hint)

    def _pair(self) -> str:
        """Return this sign together with an adjacent one before it, as other languages write them."""
        before, token = self.tokens[max(self.position - 1, 0)], self.token
        return before.text + token.text if before.end == token.offset else ""

    def too_deep(self, offset: int) -> ExpressionError:
        """Return the error for an expression with too many levels."""
        hint = "split it: assign a part to a key of the context, and use that key"
        return ExpressionError(f"the expression has more than {MAX_TREE_DEPTH} levels", offset, hint)

    def minus(self, power: int) -> ExpressionNode:
        """Parse `-operand`; directly before a number it is the sign of the number."""
        if self.tokens[self.position + 1].kind in ("int", "float"):
            following = self.tokens[self.position + 2].text
            if following not in (".", "["):
                return self.number(self.advance())
        return self.unary(power)

    def number(self, minus: Token | None = None) -> ExpressionNode:
        """Parse a number; raise ExpressionError if it exceeds 64 bits."""
        token = self.advance()
        value = token.value if isinstance(token.value, int | float) else 0
        value = -value if minus else value
        offset = minus.offset if minus else token.offset
        if isinstance(value, int) and not MIN_INT <= value <= MAX_INT:
            raise ExpressionError(f"`{token.text[:40]}` is too large", offset, "whole numbers have 64 bits")
        return Literal(value, offset=offset, end=token.end)

    def map_key(self, entries: Collection[str]) -> str:
        """Parse the key of a map entry; raise ExpressionError unless it is a text that is not in `entries`."""
        key = self.token
        if key.kind != "text":
            raise self.unexpected(f"put the key in quotes: '{key.text}'" if key.kind == "name" else "")
        if str(key.value) in entries:
            raise ExpressionError(f"the key {key.text} is in the map twice", key.offset)
        return str(self.advance().value)

    operands: ClassVar = {"int": number, "float": number, "text": PrattParser.literal, "name": PrattParser.name}
    prefixes: ClassVar = {
        "!": (7, PrattParser.unary),
        "-": (7, minus),
        "(": (0, PrattParser.group),
        "[": (0, PrattParser.list_literal),
        "{": (0, PrattParser.map_literal),
    }
    infixes: ClassVar = {
        "?": (1, PrattParser.conditional),
        "||": (2, PrattParser.logic),
        "&&": (3, PrattParser.logic),
        **dict.fromkeys(("==", "!=", "<", "<=", ">", ">=", "in"), (4, PrattParser.binary)),
        **dict.fromkeys(("+", "-"), (5, PrattParser.binary)),
        **dict.fromkeys(("*", "/", "%"), (6, PrattParser.binary)),
        ".": (8, PrattParser.member),
        "[": (8, PrattParser.index),
    }
