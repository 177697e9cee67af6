"""Facts that follow from a condition being true, or false."""

from typing import NamedTuple

from lumen.expressions.tree import (
    Binary,
    ExpressionNode,
    FieldAccess,
    FunctionCall,
    IndexAccess,
    Literal,
    Logic,
    Unary,
    path_of,
)


class KnownFacts(NamedTuple):
    """Facts guaranteed by the conditions around a node; `&` joins the facts of two conditions that are both met."""

    present: frozenset[tuple[str, ...]] = frozenset()
    """Paths of the fields that exist."""
    events: frozenset[str] | None = None
    """Names that the event can have; None if it can have any."""

    def __and__(self, other: "KnownFacts") -> "KnownFacts":
        events = [k.events for k in (self, other) if k.events is not None]
        return KnownFacts(self.present | other.present, frozenset.intersection(*events) if events else None)


def facts(node: ExpressionNode, value: bool) -> KnownFacts:
    """Return the facts that follow if the condition `node` has this value."""
    match node:
        case Unary(sign="!", operand=operand):
            return facts(operand, not value)
        case Logic(sign=sign, operands=operands) if (sign == "&&") == value:
            known = KnownFacts()
            for operand in operands:
                known &= facts(operand, value)
            return known
        case FunctionCall(function="has", arguments=(target,)) if value:
            path = path_of(target)
            return KnownFacts(prefixes(target) | {path} if path else frozenset())
        case Binary(sign=sign, left=left, right=Literal(value=str() as name)) if sign == ("==" if value else "!="):
            return KnownFacts(events=frozenset((name,))) if path_of(left) == ("event", "name") else KnownFacts()
    return KnownFacts()


def prefixes(node: ExpressionNode) -> frozenset[tuple[str, ...]]:
    """Return the paths of all values that contain the node's: `a` and `a.b` for `a.b.c`."""
    found = set()
    while isinstance(node, FieldAccess | IndexAccess):
        node = node.base
        if path := path_of(node):
            found.add(path)
    return frozenset(found)
