"""From the tree of an expression back to its text."""

import json

from lumen.interpreters.expressions.tree import (
    Binary,
    Call,
    Choice,
    Entries,
    Field,
    Index,
    Items,
    Literal,
    Logic,
    Name,
    Node,
    Unary,
)


def unparse(node: Node) -> str:
    """The expression as text; parsed again it is the same tree."""
    match node:
        case Literal(value=str() as value):
            return json.dumps(value, ensure_ascii=False).replace("\x7f", r"\x7f")
        case Literal(value=value):
            return json.dumps(value)
        case Name(name=name):
            return name
        case Field(base=base, name=name):
            return f"{_operand(base)}.{name}"
        case Index(base=base, key=key):
            return f"{_operand(base)}[{unparse(key)}]"
        case Items(items=items):
            return f"[{', '.join(map(unparse, items))}]"
        case Entries(keys=keys, values=values):
            pairs = zip(keys, values, strict=True)
            return "{" + ", ".join(f"{unparse(Literal(k))}: {unparse(v)}" for k, v in pairs) + "}"
        case Unary(sign=sign, operand=operand):
            return sign + _operand(operand)
        case Binary(sign=sign, left=left, right=right):
            return f"{_operand(left)} {sign} {_operand(right)}"
        case Logic(sign=sign, operands=operands):
            return f" {sign} ".join(map(_operand, operands))
        case Choice(condition=condition, then=then, otherwise=otherwise):
            return f"{_operand(condition)} ? {_operand(then)} : {_operand(otherwise)}"
        case Call(function=function, arguments=arguments):
            return f"{function}({', '.join(map(unparse, arguments))})"


def _operand(node: Node) -> str:
    text = unparse(node)
    bare = not isinstance(node, Unary | Binary | Logic | Choice) and not text.startswith("-")
    return text if bare and not text[0].isdigit() else f"({text})"
