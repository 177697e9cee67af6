"""Translates ECMAScript's method calls to Lumen's functions and operators."""

import re

from lumen.expressions.kinds import LIST, NUMBER, TEXT
from lumen.expressions.tree import (
    Binary,
    ExpressionNode,
    FieldAccess,
    FunctionCall,
    Identifier,
    ListLiteral,
    Literal,
)
from lumen.features.formats_charts.ecmascript.kind_inference import is_float
from lumen.features.formats_charts.ecmascript.script_parser import ScriptError
from lumen.features.formats_charts.ecmascript.translation import Translation

SIGN_FUNCTIONS = {"contained": "in", "same": "=="}
"""Functions that the writer calls for `in` with values of an unknown kind, and for `==` with lists and maps."""

LUMEN_FUNCTIONS = frozenset(
    (
        "heard",
        "lookup",
        "now",
        "hour",
        "minute",
        "weekday",
        "date",
        "words",
        "after",
        "matches",
        "contains",
        "size",
        "pick",
        "shuffle",
        *SIGN_FUNCTIONS,
    )
)
"""Functions that only Lumen has; they have the same names in exported ECMAScript."""

EQUIVALENT_METHODS = {".toLowerCase": "lower", ".trim": "trim", ".replaceAll": "replace"}
_COUNTS = {".toLowerCase": 0, ".trim": 0, ".replaceAll": 2, ".includes": 1, ".startsWith": 1, ".endsWith": 1}


def method(translation: Translation, node: FunctionCall) -> ExpressionNode:
    """Translate a method call. Raises ScriptError if it has no counterpart in Lumen."""
    name, (owner, *arguments) = node.function, node.arguments
    if owner == Identifier("Math"):
        return _mathematics(translation, name, arguments)
    if name == ".concat":
        return _joined(translation, owner, arguments)
    if _COUNTS.get(name) != len(arguments):
        raise ScriptError(f"`{name}()` has no counterpart in Lumen")
    base, *read = (translation.value(part) for part in (owner, *arguments))
    if name in EQUIVALENT_METHODS:
        return FunctionCall(EQUIVALENT_METHODS[name], (base, *read))
    if name == ".includes":
        if translation.kind(base) == LIST:
            return Binary("in", read[0], base)
        if TEXT in (translation.kind(base), translation.kind(read[0])):
            return FunctionCall("contains", (base, read[0]))
        raise ScriptError("`.includes()` is called on a value that can be a string or a list")
    if not (isinstance(read[0], Literal) and isinstance(read[0].value, str)):
        raise ScriptError(f"`{name}()` needs a string in quotes as its first argument")
    pattern = re.sub(r"([^\w\s])", r"\\\1", read[0].value, flags=re.ASCII)
    return FunctionCall("matches", (base, Literal(f"^{pattern}" if name == ".startsWith" else f"{pattern}$")))


def _joined(translation: Translation, owner: ExpressionNode, arguments: list[ExpressionNode]) -> ExpressionNode:
    parts = [translation.value(part) for part in (owner, *arguments)]
    result, *others = [part for part in parts if part != ListLiteral(())] or [ListLiteral(())]
    for other in others:
        if translation.kind(result) == TEXT or translation.kind(other) not in (LIST, ""):
            raise ScriptError("`.concat()` is called on a value that is not a list")
        result = Binary("+", result, other)
    return result


def _mathematics(translation: Translation, name: str, arguments: list[ExpressionNode]) -> ExpressionNode:
    match name, arguments:
        case ".trunc", [Binary(sign="/", left=left, right=right)]:
            read = Binary("/", translation.value(left), translation.value(right))
            if not is_float(read):
                return read
        case ".pow", [base, Literal(value=int() as power)] if 1 <= power <= 4:
            value = translation.value(base)
            if isinstance(value, FieldAccess | Literal) and translation.kind(value) in (NUMBER, ""):
                product: ExpressionNode = value
                for _ in range(power - 1):
                    product = Binary("*", product, value)
                return product
    raise ScriptError(f"`Math{name}()` has no counterpart in Lumen")
