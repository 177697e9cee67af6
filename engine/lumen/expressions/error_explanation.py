"""The explanation of a failed evaluation, in words, with its place."""

from collections.abc import Iterable, Mapping
from itertools import islice
from types import TracebackType
from typing import Any

from lumen.errors import ExpressionError
from lumen.expressions.kinds import KIND_DESCRIPTIONS, FaultError, MismatchError, WrongKindError, kind_of
from lumen.expressions.scope import Scope
from lumen.expressions.tree import (
    ExpressionNode,
    FieldAccess,
    FunctionCall,
    IndexAccess,
    children,
    path_of,
    walk,
)
from lumen.language.diagnostics import did_you_mean

EXPRESSION_FILE = "<expression>"
"""The file name in compiled expressions, by which their stack frames are recognized."""

UNKNOWN_VALUE = object()


def explain(error: Exception, source: str, tree: ExpressionNode, scope: Scope) -> ExpressionError:
    """Return the error in words for the author of the expression, for any exception of the evaluation."""
    node = _failing(error.__traceback__, tree)
    match error:
        case ExpressionError(message=message, hint=hint):
            return ExpressionError(message, node.offset, hint)
        case FaultError(message=message, hint=hint):
            return ExpressionError(message, node.offset, hint)
        case WrongKindError(operand=operand, kind=kind, wanted=wanted):
            culprit = children(node)[operand] if operand >= 0 else node
            return wrong_kind(source, node, culprit, kind, wanted)
        case MismatchError(left=left, right=right):
            message = f"{KIND_DESCRIPTIONS[left]} and {KIND_DESCRIPTIONS[right]} can't be combined in `{_sign(node)}`"
            return ExpressionError(message, node.offset)
        case KeyError() | TypeError() if isinstance(node, FieldAccess | IndexAccess):
            return _missing(error, source, node, scope)
        case RecursionError():
            return ExpressionError("a value here is nested too deeply", node.offset)
    return ExpressionError(f"this can't be evaluated: {error}", node.offset)


def wrong_kind(
    source: str, node: ExpressionNode, culprit: ExpressionNode, kind: str, wanted: tuple[str, ...]
) -> ExpressionError:
    """Return the error for `culprit`, an operand of `node` or the node itself, whose `kind` is not one of `wanted`."""
    needed = " or ".join(KIND_DESCRIPTIONS[k] for k in wanted)
    asks = f", but `{_sign(node)}` needs {needed}" if culprit is not node else f", but {needed} is needed"
    return ExpressionError(f"`{_shown(source, culprit)}` is {KIND_DESCRIPTIONS[kind]}{asks}", culprit.offset)


def _shown(source: str, node: ExpressionNode) -> str:
    """Return the source of a node on one line, shortened to 60 characters."""
    text = " ".join(source[node.offset : node.end].split())
    return text if len(text) <= 60 else f"{text[:59]}…"


def _sign(node: ExpressionNode) -> str:
    if isinstance(node, FunctionCall):
        return node.function
    return "[…]" if isinstance(node, IndexAccess) else str(getattr(node, "sign", "?"))


def _failing(traceback: TracebackType | None, tree: ExpressionNode) -> ExpressionNode:
    """Return the node whose instruction raised: its number is the line in the innermost frame of an expression."""
    number = 1
    while traceback is not None:
        if traceback.tb_frame.f_code.co_filename == EXPRESSION_FILE:
            number = traceback.tb_lineno
        traceback = traceback.tb_next
    nodes = [node for node, _ in walk(tree)]
    return nodes[min(number, len(nodes)) - 1]


def _missing(
    error: KeyError | TypeError, source: str, node: FieldAccess | IndexAccess, scope: Scope
) -> ExpressionError:
    base = _shown(source, node.base)
    at = node.end - len(node.name) if isinstance(node, FieldAccess) else node.key.offset
    name = node.name if isinstance(node, FieldAccess) else _shown(source, node.key).strip("'\"")
    value = _value(node.base, scope)
    if base == "event" and value is None:
        return ExpressionError("there is no event here", node.offset)
    if isinstance(error, KeyError):
        hint = did_you_mean(name, _few(value), f"`{base}` has") if isinstance(value, Mapping) else ""
        return ExpressionError(f"`{base}` has no `{name}`", at, hint)
    kind = KIND_DESCRIPTIONS[kind_of(value)] if value is not UNKNOWN_VALUE else "not a map"
    return ExpressionError(f"`{base}` is {kind}, so it has no `{name}`", at)


def _few(keys: Iterable[Any]) -> list[str]:
    """Return the keys worth comparing with a misspelt one: short texts, and not thousands of them."""
    return [key for key in islice(keys, 100) if isinstance(key, str) and len(key) <= 40]


def _value(node: ExpressionNode, scope: Scope) -> Any:
    """Return the value at a path; UNKNOWN_VALUE for any other node."""
    path = path_of(node)
    if path is None:
        return UNKNOWN_VALUE
    value = getattr(scope, path[0])
    for key in path[1:]:
        value = value[key]
    return value
