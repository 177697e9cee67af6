"""Random expressions that mostly have a value: each part is of a kind that the whole can use, or sometimes is not."""

from typing import Any

from hypothesis import strategies as st

from lumen.expressions import ExpressionNode, Scope
from lumen.expressions.tree import (
    Binary,
    Conditional,
    FieldAccess,
    FunctionCall,
    Identifier,
    IndexAccess,
    ListLiteral,
    Literal,
    Logic,
    MapLiteral,
    Unary,
)

KINDS = ["number", "text", "boolean", "list", "map"]
PATTERNS = ["a", "^a", "a$", "a|b", "[a-c]+", "x*", r"\d", r"\w+ \w+", "(ab)?c", ".", "a{2}", "(?i)A", r"\.", r"[^a]"]

TEXTS = st.one_of(
    st.sampled_from(["", "a", "ab", "Ab c", "dance", "x1", "é", "10"]),
    st.text("ab c", max_size=4),
    st.text(st.characters(exclude_characters="\0", exclude_categories=["Cs"]), max_size=4),
)
"""Texts without NUL, at which the oracle would cut them."""

NUMBERS = st.one_of(
    st.integers(-3, 9),
    st.sampled_from([0.5, 1.0, 2.0, -1.5, 0.0, -0.0, 1e308, 2**53 + 1, 2**63 - 1, -(2**63), 9007199254740992.0]),
    st.integers(-(2**63), 2**63 - 1),
    st.floats(allow_nan=False, allow_infinity=False),
)
SCALARS = st.none() | st.booleans() | NUMBERS | TEXTS
VALUES = st.recursive(
    SCALARS, lambda v: st.lists(v, max_size=3) | st.dictionaries(st.sampled_from("abc"), v, max_size=3), max_leaves=6
)
scopes = st.builds(
    lambda **context: Scope(context=context, event={"name": "e", "data": context["any"]}, state={"path": "p"}),
    n=NUMBERS,
    t=TEXTS,
    b=st.booleans(),
    l=st.lists(VALUES, max_size=3),
    m=st.dictionaries(st.sampled_from("abc"), VALUES, max_size=3),
    any=VALUES,
)
LETTERS = {"number": "n", "text": "t", "boolean": "b", "list": "l", "map": "m"}


@st.composite
def expressions(draw: st.DrawFn, depth: int = 4) -> ExpressionNode:
    return Writer(draw).any(depth)


class Writer:
    """Draws a random expression, from the outside to the inside."""

    def __init__(self, draw: st.DrawFn) -> None:
        self.draw = draw

    def pick(self, *options: Any) -> Any:
        return self.draw(st.sampled_from(options))

    def any(self, depth: int) -> ExpressionNode:
        return self.of(self.pick(*KINDS), depth)

    def of(self, kind: str, depth: int) -> ExpressionNode:
        """Return an expression of that kind; one in twelve is a path, or of any kind."""
        stray = self.draw(st.integers(0, 11)) == 11
        if stray:
            return self.path() if depth == 0 or self.draw(st.booleans()) else self.any(depth - 1)
        if depth == 0 or self.draw(st.integers(0, 4)) == 4:
            return self.leaf(kind)
        if self.draw(st.integers(0, 7)) == 7:
            return Conditional(self.of("boolean", depth - 1), self.of(kind, depth - 1), self.of(kind, depth - 1))
        written: ExpressionNode = getattr(self, kind)(depth - 1)
        return written

    def leaf(self, kind: str) -> ExpressionNode:
        if self.draw(st.booleans()):
            return FieldAccess(Identifier("context"), LETTERS[kind])
        match kind:
            case "number":
                return Literal(self.draw(NUMBERS))
            case "text":
                return Literal(self.draw(TEXTS))
            case "boolean":
                return Literal(self.draw(st.booleans()))
            case "list":
                return ListLiteral(tuple(Literal(value) for value in self.draw(st.lists(SCALARS, max_size=3))))
        values = self.draw(st.dictionaries(st.sampled_from("abc"), SCALARS, max_size=3))
        return MapLiteral(tuple(values), tuple(map(Literal, values.values())))

    def path(self) -> ExpressionNode:
        """Return a path that may lead nowhere."""
        node: ExpressionNode = FieldAccess(Identifier("context"), self.pick("any", "m", "l", "n", "none"))
        if self.draw(st.booleans()):
            node = FieldAccess(Identifier("event"), "data")
        for _ in range(self.draw(st.integers(0, 2))):
            node = FieldAccess(node, self.pick("a", "b", "c"))
        return node

    def number(self, depth: int) -> ExpressionNode:
        match self.draw(st.integers(0, 5)):
            case 0:
                return FunctionCall("size", (self.of(self.pick("text", "list", "map"), depth),))
            case 1:
                operand = self.of("number", depth)
                return operand if isinstance(operand, Literal) else Unary("-", operand)
        return Binary(self.pick("+", "-", "*", "/", "%"), self.of("number", depth), self.of("number", depth))

    def text(self, depth: int) -> ExpressionNode:
        match self.draw(st.integers(0, 3)):
            case 0:
                return FunctionCall(self.pick("lower", "trim"), (self.of("text", depth),))
            case 1:
                return FunctionCall("replace", tuple(self.of("text", depth) for _ in range(3)))
        return Binary("+", self.of("text", depth), self.of("text", depth))

    def boolean(self, depth: int) -> ExpressionNode:
        match self.draw(st.integers(0, 7)):
            case 0 | 1:
                operands = [self.of("boolean", depth) for _ in range(self.draw(st.integers(2, 3)))]
                return Logic(self.pick("&&", "||"), tuple(operands))
            case 2:
                return Unary("!", self.of("boolean", depth))
            case 3:
                return Binary("in", self.any(depth), self.of(self.pick("list", "map"), depth))
            case 4:
                return Binary(self.pick("==", "!="), self.any(depth), self.any(depth))
            case 5:
                return FunctionCall("contains", (self.of("text", depth), self.of("text", depth)))
            case 6:
                path = self.path()
                asked = self.draw(st.booleans()) and isinstance(path, FieldAccess)
                return (
                    FunctionCall("has", (path,))
                    if asked
                    else FunctionCall("matches", (self.of("text", depth), Literal(self.pick(*PATTERNS))))
                )
        kind = self.pick("number", "text", "boolean")
        return Binary(self.pick("==", "!=", "<", "<=", ">", ">="), self.of(kind, depth), self.of(kind, depth))

    def list(self, depth: int) -> ExpressionNode:
        if self.draw(st.booleans()):
            return Binary("+", self.of("list", depth), self.of("list", depth))
        return ListLiteral(tuple(self.any(depth) for _ in range(self.draw(st.integers(0, 3)))))

    def map(self, depth: int) -> ExpressionNode:
        keys = self.draw(st.lists(st.sampled_from("abc"), unique=True, max_size=3))
        entries = MapLiteral(tuple(keys), tuple(self.any(depth) for _ in keys))
        match self.draw(st.integers(0, 3)):
            case 0:
                return IndexAccess(self.of("list", depth), self.of("number", depth))
            case 1:
                return IndexAccess(self.of("map", depth), Literal(self.pick("a", "b", "c")))
        return entries
