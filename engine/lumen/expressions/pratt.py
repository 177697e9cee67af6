"""A parser for operator precedence, the base of every expression language here.

V. Pratt, "Top Down Operator Precedence", POPL 1973. A language is a subclass with three tables: the signs at the
beginning of an expression, the kinds of tokens that are operands, and the continuations of a left side (operators, `?
:`, `.field`, `[index]`), each with the power with which it binds its operands: an operand between two operators belongs
to the stronger one.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable, Collection, Mapping
from typing import Any, ClassVar

from lumen.expressions.scope import MAX_TREE_DEPTH
from lumen.expressions.tokens import Token
from lumen.expressions.tree import (
    Binary,
    Conditional,
    ExpressionNode,
    FieldAccess,
    FunctionCall,
    Identifier,
    IndexAccess,
    ListLiteral,
    Literal,
    Logic,
    MapLiteral,
    Unary,
    walk,
)

CONSTANTS: Mapping[str, bool | None] = {"true": True, "false": False, "null": None}
"""The names that are literals."""

Prefix = tuple[int, Callable[[Any, int], ExpressionNode]]
"""A power, and the parser's method that receives it and parses the sign with its operand."""

Infix = tuple[int, Callable[[Any, ExpressionNode, Token, int], ExpressionNode]]
"""A power, and the parser's method that receives the left side, the sign (already consumed) and the power."""


class PrattParser(ABC):
    """One pass over tokens, the last of which has the kind `end`; `token` is the next token.

    Methods raise the errors of `unexpected` and `too_deep`.
    """

    prefixes: ClassVar[Mapping[str, Prefix]]
    operands: ClassVar[Mapping[str, Callable[[Any], ExpressionNode]]]
    infixes: ClassVar[Mapping[str, Infix]]

    reserved: ClassVar[Collection[str]] = ()
    """Names that can't be operands."""

    method_prefix: ClassVar[str] = ""
    """Prefix of the function name that a call `a.name()` gets."""

    max_levels: ClassVar[int]
    """The greatest nesting of expressions; brackets count here, although they are not in the tree."""

    def __init__(self, tokens: list[Token]) -> None:
        self.tokens, self.token, self.position, self.level = tokens, tokens[0], 0, 0

    @abstractmethod
    def unexpected(self, hint: str = "") -> Exception:
        """Return the error for a token that is not allowed at its place."""

    @abstractmethod
    def too_deep(self, offset: int) -> Exception:
        """Return the error for too many levels."""

    def whole(self) -> ExpressionNode:
        """Parse all tokens; return the tree."""
        tree = self.expression(0)
        if self.token.kind != "end":
            raise self.unexpected()
        return tree

    def bounded(self) -> ExpressionNode:
        """Parse all tokens; return the tree, which has at most MAX_TREE_DEPTH levels."""
        tree = self.whole()
        for node, level in walk(tree):
            if level > MAX_TREE_DEPTH:
                raise self.too_deep(node.offset)
        return tree

    def expression(self, power: int) -> ExpressionNode:
        """Parse an expression whose operators all bind more tightly than `power`."""
        self.level += 1
        if self.level > self.max_levels:
            raise self.too_deep(self.token.offset)
        left, infixes = self.begin(), self.infixes
        while (infix := infixes.get(self.token.text)) and infix[0] > power:
            left = infix[1](self, left, self.advance(), infix[0])
        self.level -= 1
        return left

    def begin(self) -> ExpressionNode:
        """Parse the part before the first operator."""
        if prefix := self.prefixes.get(self.token.text):
            return prefix[1](self, prefix[0])
        if operand := self.operands.get(self.token.kind):
            return operand(self)
        raise self.unexpected()

    # Tokens

    def advance(self) -> Token:
        """Consume the next token and return it."""
        read = self.token
        self.position += 1
        self.token = self.tokens[self.position]
        return read

    def accept(self, text: str) -> bool:
        """Consume the next token if it is `text`; return whether it was."""
        found = self.token.text == text
        if found:
            self.advance()
        return found

    def expect(self, text: str) -> Token:
        """Consume the next token, which must be `text`, and return it."""
        if self.token.text != text:
            raise self.unexpected(f"a `{text}` is missing")
        return self.advance()

    # Beginnings of an expression

    def literal(self) -> ExpressionNode:
        """Parse a number or a text."""
        token = self.advance()
        return Literal(token.value, offset=token.offset, end=token.end)

    def name(self) -> ExpressionNode:
        """Parse `true`, `f(…)` or a name."""
        if self.token.text in self.reserved:
            raise self.unexpected()
        token = self.advance()
        if token.text in CONSTANTS:
            return Literal(CONSTANTS[token.text], offset=token.offset, end=token.end)
        if self.accept("("):
            arguments, end = self.listed(")")
            return FunctionCall(token.text, arguments, token.offset, offset=token.offset, end=end)
        return Identifier(token.text, offset=token.offset, end=token.end)

    def unary(self, power: int) -> Unary:
        """Parse a prefix operator and its operand, as in `!operand`."""
        sign = self.advance()
        operand = self.expression(power)
        return Unary(sign.text, operand, offset=sign.offset, end=operand.end)

    def group(self, power: int) -> ExpressionNode:
        """Parse `(inner)`."""
        self.advance()
        inner = self.expression(power)
        self.expect(")")
        return inner

    def list_literal(self, _: int) -> ExpressionNode:
        """Parse `[items]`."""
        start = self.advance()
        items, end = self.listed("]")
        return ListLiteral(items, offset=start.offset, end=end)

    def map_literal(self, power: int) -> ExpressionNode:
        """Parse `{key: value}`."""
        start = self.advance()
        entries: dict[str, ExpressionNode] = {}
        while self.token.text != "}":
            key = self.map_key(entries)
            self.expect(":")
            entries[key] = self.expression(power)
            if not self.accept(","):
                break
        end = self.expect("}").end
        return MapLiteral(tuple(entries), tuple(entries.values()), offset=start.offset, end=end)

    def map_key(self, entries: Collection[str]) -> str:
        """Parse the key of the next entry; `entries` has the previous ones."""
        raise self.unexpected()

    # Continuations of a left side

    def binary(self, left: ExpressionNode, sign: Token, power: int) -> ExpressionNode:
        """Parse the rest of `left sign right`, which associates to the left."""
        right = self.expression(power)
        return Binary(sign.text, left, right, offset=left.offset, end=right.end)

    def logic(self, left: ExpressionNode, sign: Token, power: int) -> ExpressionNode:
        """Parse the rest of `left && right`; several operands become one node."""
        operands = [left, self.expression(power)]
        while self.accept(sign.text):
            operands.append(self.expression(power))
        return Logic(sign.text, tuple(operands), offset=left.offset, end=operands[-1].end)

    def conditional(self, left: ExpressionNode, _: Token, __: int) -> ExpressionNode:
        """Parse the rest of `left ? then : otherwise`."""
        then = self.expression(0)
        self.expect(":")
        otherwise = self.expression(0)
        return Conditional(left, then, otherwise, offset=left.offset, end=otherwise.end)

    def index(self, left: ExpressionNode, _: Token, __: int) -> ExpressionNode:
        """Parse the rest of `left[key]`."""
        key = self.expression(0)
        return IndexAccess(left, key, offset=left.offset, end=self.expect("]").end)

    def member(self, left: ExpressionNode, _: Token, __: int) -> ExpressionNode:
        """Parse the rest of `left.field` or `left.function(arguments)`, a call with `left` as its first argument."""
        if self.token.kind != "name":
            raise self.unexpected("write a name after the `.`")
        name = self.advance()
        if not self.accept("("):
            return FieldAccess(left, name.text, offset=left.offset, end=name.end)
        arguments, end = self.listed(")")
        function = self.method_prefix + name.text
        return FunctionCall(function, (left, *arguments), name.offset, offset=left.offset, end=end)

    def listed(self, close: str) -> tuple[tuple[ExpressionNode, ...], int]:
        """Parse expressions between commas up to `close`; return them and the end of `close`.

        A trailing comma is allowed.
        """
        items: list[ExpressionNode] = []
        while self.token.text != close:
            items.append(self.expression(0))
            if not self.accept(","):
                break
        return tuple(items), self.expect(close).end
