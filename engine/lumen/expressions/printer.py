"""Converts the tree of an expression back to text, with as few brackets as possible."""

from collections.abc import Iterable

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
)

_CHOICE, _OR, _AND, _RELATION, _SUM, _PRODUCT, _UNARY, _POSTFIX = range(1, 9)
_ARITHMETIC = {"+": _SUM, "-": _SUM, "*": _PRODUCT, "/": _PRODUCT, "%": _PRODUCT}
_ESCAPES = {"\\": "\\\\", "'": "\\'", "\n": "\\n", "\t": "\\t", "\r": "\\r"}


def unparse(node: ExpressionNode) -> str:
    """Return the expression as text, which parses to the same tree.

    This also serves other languages with these operators (CEL, ECMAScript): a call of `.name` becomes a method call.
    """
    match node:
        case Literal(value=value):
            return _literal(value)
        case Identifier(name=name):
            return name
        case FieldAccess(base=base, name=name):
            return f"{_at_least(_POSTFIX, base)}.{name}"
        case IndexAccess(base=base, key=key):
            return f"{_at_least(_POSTFIX, base)}[{unparse(key)}]"
        case ListLiteral(items=items):
            return f"[{_listed(items)}]"
        case MapLiteral(keys=keys, values=values):
            pairs = zip(keys, values, strict=True)
            return "{" + ", ".join(f"{_literal(key)}: {unparse(value)}" for key, value in pairs) + "}"
        case Unary(sign=sign, operand=operand):
            return _unary(sign, operand)
        case Binary(sign=sign, left=left, right=right):
            own = _ARITHMETIC.get(sign, _RELATION)
            first = _at_least(own + (own == _RELATION), left)
            return f"{first} {sign} {_at_least(own + 1, right)}"
        case Logic(sign=sign, operands=operands):
            own = _AND if sign == "&&" else _OR
            return f" {sign} ".join(_at_least(own + 1, operand) for operand in operands)
        case Conditional(condition=condition, then=then, otherwise=otherwise):
            return f"{_at_least(_OR, condition)} ? {_at_least(_OR, then)} : {unparse(otherwise)}"
        case FunctionCall(function=function, arguments=arguments) if function.startswith("."):
            return f"{_at_least(_POSTFIX, arguments[0])}{function}({_listed(arguments[1:])})"
        case FunctionCall(function=function, arguments=arguments):
            return f"{function}({_listed(arguments)})"


def _listed(nodes: Iterable[ExpressionNode]) -> str:
    return ", ".join(map(unparse, nodes))


def _unary(sign: str, operand: ExpressionNode) -> str:
    """Return the text, with brackets around an operand that is a sign or a number.

    `-1` is a number, and some implementations of CEL read `!!x` as `x`.
    """
    text = _at_least(_POSTFIX, operand)
    return f"{sign} {text}" if sign.isalpha() else sign + text


def _at_least(power: int, node: ExpressionNode) -> str:
    text = unparse(node)
    return text if _power(node, text) >= power else f"({text})"


def _power(node: ExpressionNode, text: str) -> int:
    match node:
        case Conditional():
            return _CHOICE
        case Logic(sign=sign):
            return _AND if sign == "&&" else _OR
        case Binary(sign=sign):
            return _ARITHMETIC.get(sign, _RELATION)
        case Unary():
            return _UNARY
        case Literal(value=int() | float()) if not isinstance(node.value, bool):
            return _UNARY
    return _POSTFIX


def _literal(value: object) -> str:
    if isinstance(value, str):
        return "'" + "".join(_escaped(character) for character in value) + "'"
    return "null" if value is None else repr(value).lower()


def _escaped(character: str) -> str:
    if character in _ESCAPES:
        return _ESCAPES[character]
    if character.isprintable():
        return character
    code = ord(character)
    return f"\\x{code:02x}" if code < 0x100 else f"\\u{code:04x}" if code < 0x10000 else character
