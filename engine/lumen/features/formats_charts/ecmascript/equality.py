"""Translates ECMAScript's tests for equality, including those of values that are or may be missing."""

from lumen.expressions.kinds import LIST, MAP, NULL
from lumen.expressions.tree import (
    Binary,
    ExpressionNode,
    FieldAccess,
    FunctionCall,
    Identifier,
    Literal,
    Logic,
    Unary,
    path_of,
)
from lumen.features.formats_charts.ecmascript.kind_inference import UNKNOWN_KIND, is_data, negated
from lumen.features.formats_charts.ecmascript.script_parser import ScriptError
from lumen.features.formats_charts.ecmascript.translation import Translation

EVENT, HAPPENED = Identifier("_event"), FunctionCall("has", (FieldAccess(Identifier("event"), "name"),))
"""The event as a whole, and the test that it exists: `_event` is undefined before the first event (SCXML 5.10.1)."""

_UNDEFINED = Identifier("undefined")


def equality(translation: Translation, node: Binary) -> ExpressionNode:
    """Translate a comparison by `==`, `!=`, `===` or `!==`.

    Raises ScriptError if it has no counterpart in Lumen.
    """
    positive, strict = node.sign in ("==", "==="), len(node.sign) == 3
    found = _undefined(translation, node, strict) or _index(translation, node) or _equal(translation, node, strict)
    return found if positive else negated(found)


def _undefined(translation: Translation, node: Binary, strict: bool) -> ExpressionNode | None:
    """Translate a test that a value is missing; return None for any other comparison.

    Such tests are `typeof x === 'undefined'`, `x === undefined` and `x == null`. Raises ScriptError if `typeof` is
    compared with anything but 'undefined'.
    """
    for one, other in ((node.left, node.right), (node.right, node.left)):
        kind_asked = isinstance(one, Unary) and one.sign == "typeof"
        if isinstance(one, Unary) and kind_asked and other != Literal("undefined"):
            raise ScriptError("`typeof` can only be compared with 'undefined'")
        if isinstance(one, Unary) and kind_asked:
            return _absent(translation, one.operand, False)
        if one == _UNDEFINED or (one == Literal(None) and not strict):
            return _absent(translation, other, not strict)
    return None


def _absent(translation: Translation, tree: ExpressionNode, or_null: bool) -> ExpressionNode:
    if tree == EVENT:
        return negated(HAPPENED)
    node = translation.value(tree)
    path = path_of(node)
    is_null = Binary("==", node, Literal(None))
    if not is_data(path) or path in translation.present:
        return is_null
    missing = Unary("!", FunctionCall("has", (node,)))
    return Logic("||", (missing, is_null)) if or_null else missing


def _index(translation: Translation, node: Binary) -> ExpressionNode | None:
    """Translate `text.indexOf(part) == -1` to `!contains(text, part)`; return None for any other comparison."""
    match node:
        case Binary(left=FunctionCall(function=".indexOf", arguments=(text, part)), right=Literal(value=-1)):
            return Unary("!", FunctionCall("contains", (translation.value(text), translation.value(part))))
    return None


def _equal(translation: Translation, node: Binary, strict: bool) -> ExpressionNode:
    left, right = translation.value(node.left), translation.value(node.right)
    kinds = {translation.kind(left), translation.kind(right)} - {UNKNOWN_KIND}
    if kinds & {LIST, MAP}:
        raise ScriptError("ECMAScript compares lists and objects by identity, Lumen by value")
    if len(kinds) == 2 and NULL not in kinds:
        if not strict:
            raise ScriptError("`==` compares values of different types, which ECMAScript would convert")
        return Literal(False)
    return guarded(translation, Binary("==", left, right), left, right)


def guarded(translation: Translation, node: ExpressionNode, *operands: ExpressionNode) -> ExpressionNode:
    """Return the comparison, guarded to be false if an operand is a missing event field (undefined in ECMAScript)."""
    paths = {path: operand for operand in operands if is_data(path := path_of(operand))}
    missing = [FunctionCall("has", (operand,)) for path, operand in paths.items() if path not in translation.present]
    return Logic("&&", (*missing, node)) if missing else node
