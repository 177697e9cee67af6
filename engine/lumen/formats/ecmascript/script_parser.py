"""From the text of an ECMAScript expression to its tree."""

from lumen.formats.ecmascript.script_tokens import ScriptError, ScriptToken, tokenize_script
from lumen.interpreters.expressions.scope import MAX_TREE_DEPTH
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
)

_RELATIONS = ("<", "<=", ">", ">=", "in")
_EQUALITIES = ("==", "!=", "===", "!==")
_POWERS = (
    {"?": 1, "||": 2, "&&": 3} | dict.fromkeys(_EQUALITIES, 4) | dict.fromkeys(_RELATIONS, 5)
    | {"+": 6, "-": 6, "*": 7, "/": 7, "%": 7}
)  # fmt: skip
_UNARY = 8
_LITERALS: dict[str, bool | None] = {"true": True, "false": False, "null": None}
_FOREIGN = {
    "function": "functions", "new": "`new`", "instanceof": "`instanceof`", "=": "assignments", "++": "`++`",
    "--": "`--`", "+=": "assignments", "-=": "assignments", "=>": "functions", "&": "operators on bits",
    "|": "operators on bits", "^": "operators on bits", "~": "operators on bits", "void": "`void`",
    "delete": "`delete`", "this": "`this`", "**": "powers", ";": "several statements", "return": "`return`",
    "var": "declarations", "let": "declarations", "const": "declarations",
}  # fmt: skip
_RESERVED = frozenset((
    "undefined", "NaN", "Infinity", "Math", "JSON", "Object", "Array", "String", "Number", "typeof", "in", "if",
    "else", "for", "while", "do", "switch", "case", "default", "break", "continue", "throw", "try", "catch",
    "finally", "with", "class", "extends", "super", "import", "export", "debugger", "enum", "yield", "await",
    "_event", "_name", "_sessionid", "_ioprocessors", "_x",
))  # fmt: skip
_MAX_LEVEL = 45

__all__ = ["ScriptError", "parse_script"]


def parse_script(source: str) -> ExpressionNode:
    """The tree of an expression; raises ScriptError where it is none, or uses what our language has not."""
    parser = _Parser(tokenize_script(source))
    tree = parser.expression(0)
    if parser.word.kind != "end":
        raise parser.unexpected()
    if any(level > MAX_TREE_DEPTH for _, level in walk(tree)):
        raise ScriptError("it has too many levels")
    return tree


def is_reserved(name: str) -> bool:
    """Whether ECMAScript, or SCXML, means something by it."""
    return name in _FOREIGN or name in _LITERALS or name in _RESERVED


class _Parser:
    """One pass over the words (Pratt, 1973); `word` is the next one."""

    def __init__(self, found: list[ScriptToken]) -> None:
        self.words, self.position, self.level = found, 0, 0

    @property
    def word(self) -> ScriptToken:
        return self.words[self.position]

    def advance(self) -> ScriptToken:
        self.position += 1
        return self.words[self.position - 1]

    def accept(self, text: str) -> bool:
        found = self.word.text == text and self.word.kind in ("sign", "name")
        self.position += found
        return found

    def expect(self, text: str) -> None:
        if not self.accept(text):
            raise self.unexpected()

    def unexpected(self) -> ScriptError:
        word = self.word
        if word.kind == "end":
            return ScriptError("it ends too early")
        if word.kind != "text" and word.text in _FOREIGN:
            return ScriptError(f"Lumen's expressions have no {_FOREIGN[word.text]}")
        return ScriptError(f"`{word.text[:40]}` can't stand there")

    def expression(self, power: int) -> ExpressionNode:
        """An expression whose operators all bind more tightly than `power`."""
        self.level += 1
        if self.level > _MAX_LEVEL:
            raise ScriptError("it has too many levels")
        left = self.prefix()
        while self.word.kind in ("sign", "name") and (stronger := _POWERS.get(self.word.text, 0)) > power:
            left = self.infix(left, stronger)
        self.level -= 1
        return left

    def infix(self, left: ExpressionNode, power: int) -> ExpressionNode:
        sign = self.advance().text
        if sign == "?":
            then = self.expression(0)
            self.expect(":")
            return Conditional(left, then, self.expression(0))
        right = self.expression(power)
        if sign not in ("&&", "||"):
            return Binary(sign, left, right)
        operands = [left, right]
        while self.accept(sign):
            operands.append(self.expression(power))
        return Logic(sign, tuple(operands))

    def prefix(self) -> ExpressionNode:
        word = self.word
        if word.kind not in ("sign", "name") or word.text not in ("!", "-", "+", "typeof"):
            return self.postfix(self.primary())
        self.advance()
        operand = self.expression(_UNARY)
        if word.text == "-" and isinstance(operand, Literal) and type(operand.value) in (int, float):
            assert isinstance(operand.value, int | float)
            return Literal(-operand.value)
        return Unary(word.text, operand)

    def primary(self) -> ExpressionNode:
        word = self.word
        if word.kind in ("number", "text"):
            self.advance()
            return Literal(word.value)
        if word.kind == "name" and word.text not in _FOREIGN and word.text not in _POWERS:
            self.advance()
            if word.text in _LITERALS:
                return Literal(_LITERALS[word.text])
            if self.accept("("):
                return FunctionCall(word.text, self.listed(")"))
            return Identifier(word.text)
        if self.accept("("):
            inner = self.expression(0)
            self.expect(")")
            return inner
        if self.accept("["):
            return ListLiteral(self.listed("]"))
        if self.accept("{"):
            return self.entries()
        raise self.unexpected()

    def postfix(self, node: ExpressionNode) -> ExpressionNode:
        """The node with the fields, indices and calls that follow it."""
        while True:
            if self.accept("."):
                if self.word.kind != "name":
                    raise self.unexpected()
                name = self.advance().text
                node = (
                    FunctionCall(f".{name}", (node, *self.listed(")"))) if self.accept("(") else FieldAccess(node, name)
                )
            elif self.accept("["):
                node = IndexAccess(node, self.expression(0))
                self.expect("]")
            elif self.word == ScriptToken("sign", "("):
                raise ScriptError("only functions with a name can be called")
            else:
                return node

    def listed(self, close: str) -> tuple[ExpressionNode, ...]:
        items: list[ExpressionNode] = []
        while not self.accept(close):
            items.append(self.expression(0))
            if not self.accept(","):
                self.expect(close)
                break
        return tuple(items)

    def entries(self) -> ExpressionNode:
        entries: dict[str, ExpressionNode] = {}
        while not self.accept("}"):
            key = self.advance()
            if key.kind == "sign" or key.kind == "end":
                self.position -= 1
                raise self.unexpected()
            self.expect(":")
            entries[str(key.value if key.kind != "name" else key.text)] = self.expression(0)
            if not self.accept(","):
                self.expect("}")
                break
        return MapLiteral(tuple(entries), tuple(entries.values()))
