"""Evaluates numbers, strings, lists and simple arithmetic in a Python file, without running the file."""

import ast
import math
from collections.abc import Callable, Mapping
from operator import add, mul, sub, truediv
from typing import Any

from lumen.project.formats.joint_curves import MAX_NUMBER

_SIGNS: Mapping[type[ast.operator], Callable[[Any, Any], Any]] = {
    ast.Add: add,
    ast.Sub: sub,
    ast.Mult: mul,
    ast.Div: truediv,
}
_CONSTANTS = {"pi": math.pi, "TO_RAD": math.radians(1.0), "TO_DEG": math.degrees(1.0), "True": True, "False": False}
_FUNCTIONS: Mapping[str, Callable[[float], float]] = {"radians": math.radians, "float": float}


class NotWrittenOutError(ValueError):
    """A value can't be determined without running the file; `node` is the computed part."""

    def __init__(self, node: ast.AST) -> None:
        super().__init__(written(node)[:60])
        self.node = node


def written(node: ast.AST) -> str:
    """Return a node's source text, or empty if Python can't write it, such as a number with thousands of digits."""
    try:
        return ast.unparse(node)
    except (ValueError, RecursionError):
        return ""


def value_of(node: ast.expr, names: Mapping[str, Any]) -> Any:
    """Return a node's value; `names` has the known variables. Raises NotWrittenOutError if it must be computed."""
    match node:
        case ast.Constant(value=value) if value is None or isinstance(value, str | int | float):
            return value
        case ast.List(elts=items) | ast.Tuple(elts=items):
            return [value_of(item, names) for item in items]
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            return -_number(operand, names)
        case ast.BinOp(op=op, left=left, right=right) if type(op) in _SIGNS:
            one, other = _number(left, names), _number(right, names)
            if isinstance(op, ast.Div) and other == 0:
                raise NotWrittenOutError(node)
            return _SIGNS[type(op)](one, other)
        case ast.Name(id=name) if name in names:
            return names[name]
        case ast.Name(id=name) | ast.Attribute(attr=name) if name in _CONSTANTS:
            return _CONSTANTS[name]
        case ast.Call(func=ast.Name(id=name) | ast.Attribute(attr=name), args=[argument]) if name in _FUNCTIONS:
            return _FUNCTIONS[name](_number(argument, names))
        case ast.Call(func=ast.Name(id="list"), args=[]):
            return []
        case ast.Call(func=ast.Name(id="len"), args=[argument]) if isinstance(items := value_of(argument, names), list):
            return len(items)
        case ast.Subscript(value=value, slice=index):
            items, i = value_of(value, names), value_of(index, names)
            if isinstance(items, list) and isinstance(i, int) and -len(items) <= i < len(items):
                return items[i]
    raise NotWrittenOutError(node)


def _number(node: ast.expr, names: Mapping[str, Any]) -> float:
    value = value_of(node, names)
    if isinstance(value, int | float) and abs(value) < MAX_NUMBER:
        return float(value)
    raise NotWrittenOutError(node)
