"""From the text of an expression to its tree: a parser that climbs operator precedence (Pratt, 1973)."""

from lumen.errors import ExpressionError
from lumen.interpreters.expressions.scope import MAX_INT, MAX_TREE_DEPTH, MIN_INT
from lumen.interpreters.expressions.tokens import Token, tokenize
from lumen.interpreters.expressions.tree import (
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
)  # fmt: skip

_RELATIONS = ("==", "!=", "<", "<=", ">", ">=", "in")
_POWERS = {"?": 1, "||": 2, "&&": 3} | dict.fromkeys(_RELATIONS, 4) | {"+": 5, "-": 5, "*": 6, "/": 6, "%": 6}
_UNARY = 7
_WORDS: dict[str, bool | None] = {"true": True, "false": False, "null": None}
_HINTS = {
    "and": "write `&&`", "or": "write `||`", "not": "write `!`", "is": "compare with `==`", "None": "write `null`",
    "True": "write `true`", "False": "write `false`", "if": "write `condition ? then : otherwise`",
}  # fmt: skip
_PAIRS = {
    "**": "there are no powers; multiply", "//": "between whole numbers `/` leaves out the fraction; no comments here",
    "<>": "write `!=`", "=>": "write `>=`", "=<": "write `<=`", "++": "give it a new value with `assign`",
    "??": "ask with `has(…) ? … : …`", "?.": "ask `has(…)` first",
}  # fmt: skip
"""Signs of other languages that are two tokens here."""


def parse_expression(source: str) -> ExpressionNode:
    """The tree of an expression; raises ExpressionError with the offset of what can't be read."""
    parser = _Parser(tokenize(source))
    tree = parser.expression(0)
    if parser.token.kind != "end":
        raise parser.unexpected()
    for node, level in walk(tree):
        if level > MAX_TREE_DEPTH:
            raise _too_deep(node.offset)
    return tree


def _too_deep(offset: int) -> ExpressionError:
    hint = "split it, and keep a part in the context with `assign`"
    return ExpressionError(f"the expression has more than {MAX_TREE_DEPTH} levels", offset, hint)


class _Parser:
    """One pass over the tokens; `token` is the next one."""

    def __init__(self, tokens: list[Token]) -> None:
        self.tokens, self.position, self.level = tokens, 0, 0

    @property
    def token(self) -> Token:
        return self.tokens[self.position]

    def advance(self) -> Token:
        self.position += 1
        return self.tokens[self.position - 1]

    def accept(self, text: str) -> bool:
        found = self.token.text == text
        self.position += found
        return found

    def expect(self, text: str) -> Token:
        if self.token.text != text:
            raise self.unexpected(f"a `{text}` is missing")
        return self.advance()

    def unexpected(self, hint: str = "") -> ExpressionError:
        token = self.token
        if token.kind == "end":
            what = "the expression ends too early" if self.position else "there is no expression"
            return ExpressionError(what, token.offset, hint)
        hint = _PAIRS.get(self._pair(), _HINTS.get(token.text, hint))
        return ExpressionError(f"`{token.text[:40]}` can't stand here", token.offset, hint)

    def _pair(self) -> str:
        """This sign and the one right before it, as other languages write them together."""
        before, token = self.tokens[max(self.position - 1, 0)], self.token
        return before.text + token.text if before.end == token.offset else ""

    def expression(self, power: int) -> ExpressionNode:
        """An expression whose operators all bind more tightly than `power`."""
        self.level += 1
        if self.level > 2 * MAX_TREE_DEPTH:  # brackets make levels here, though none in the tree
            raise _too_deep(self.token.offset)
        left = self.prefix()
        while (stronger := _POWERS.get(self.token.text, 0)) > power:
            left = self.infix(left, stronger)
        self.level -= 1
        return left

    def infix(self, left: ExpressionNode, power: int) -> ExpressionNode:
        sign = self.advance().text
        if sign == "?":
            then = self.expression(0)
            self.expect(":")
            otherwise = self.expression(0)
            return Conditional(left, then, otherwise, offset=left.offset, end=otherwise.end)
        right = self.expression(power)
        if sign not in ("&&", "||"):
            return Binary(sign, left, right, offset=left.offset, end=right.end)
        operands = [left, right]
        while self.accept(sign):
            operands.append(self.expression(power))
        return Logic(sign, tuple(operands), offset=left.offset, end=operands[-1].end)

    def prefix(self) -> ExpressionNode:
        token = self.token
        if token.text not in ("!", "-"):
            return self.postfix(self.primary())
        self.advance()
        if token.text == "-" and self.token.kind in ("int", "float"):
            following = self.tokens[self.position + 1].text
            if following not in (".", "["):
                return self.number(self.advance(), token)
        operand = self.expression(_UNARY)
        return Unary(token.text, operand, offset=token.offset, end=operand.end)

    def number(self, token: Token, minus: Token | None = None) -> ExpressionNode:
        value = token.value if isinstance(token.value, int | float) else 0
        value = -value if minus else value
        offset = minus.offset if minus else token.offset
        if isinstance(value, int) and not MIN_INT <= value <= MAX_INT:
            raise ExpressionError(f"`{token.text[:40]}` is too large", offset, "whole numbers have 64 bits")
        return Literal(value, offset=offset, end=token.end)

    def primary(self) -> ExpressionNode:
        token = self.token
        match token.kind:
            case "int" | "float":
                return self.number(self.advance())
            case "text":
                self.advance()
                return Literal(token.value, offset=token.offset, end=token.end)
            case "name":
                return self.name()
        if self.accept("("):
            inner = self.expression(0)
            self.expect(")")
            return inner
        if self.accept("["):
            items, end = self.listed("]")
            return ListLiteral(items, offset=token.offset, end=end)
        if self.accept("{"):
            return self.entries(token)
        raise self.unexpected()

    def name(self) -> ExpressionNode:
        token = self.token
        if token.text in _HINTS or token.text == "in":
            raise self.unexpected()
        self.advance()
        if token.text in _WORDS:
            return Literal(_WORDS[token.text], offset=token.offset, end=token.end)
        if self.accept("("):
            arguments, end = self.listed(")")
            return FunctionCall(token.text, arguments, token.offset, offset=token.offset, end=end)
        return Identifier(token.text, offset=token.offset, end=token.end)

    def postfix(self, node: ExpressionNode) -> ExpressionNode:
        """The node with the fields, indices and calls that follow it."""
        while True:
            if self.accept("."):
                node = self.member(node)
            elif self.accept("["):
                key = self.expression(0)
                node = IndexAccess(node, key, offset=node.offset, end=self.expect("]").end)
            else:
                return node

    def member(self, base: ExpressionNode) -> ExpressionNode:
        token = self.token
        if token.kind != "name":
            raise self.unexpected("a name follows a `.`")
        self.advance()
        if not self.accept("("):
            return FieldAccess(base, token.text, offset=base.offset, end=token.end)
        arguments, end = self.listed(")")
        return FunctionCall(token.text, (base, *arguments), token.offset, offset=base.offset, end=end)

    def listed(self, close: str) -> tuple[tuple[ExpressionNode, ...], int]:
        """Expressions between commas up to `close`, and where that ends; a last comma is allowed."""
        items: list[ExpressionNode] = []
        while self.token.text != close:
            items.append(self.expression(0))
            if not self.accept(","):
                break
        return tuple(items), self.expect(close).end

    def entries(self, start: Token) -> ExpressionNode:
        entries: dict[str, ExpressionNode] = {}
        while self.token.text != "}":
            key = self.token
            if key.kind != "text":
                raise self.unexpected(f"put the key in quotes: '{key.text}'" if key.kind == "name" else "")
            if str(key.value) in entries:
                raise ExpressionError(f"the key {key.text} stands twice", key.offset)
            self.advance()
            self.expect(":")
            entries[str(key.value)] = self.expression(0)
            if not self.accept(","):
                break
        end = self.expect("}").end
        return MapLiteral(tuple(entries), tuple(entries.values()), offset=start.offset, end=end)
