"""What a condition makes sure of where it is true, or false."""

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
    """What the conditions around a node make sure of: fields that are there, and which events it can be."""

    present: frozenset[tuple[str, ...]] = frozenset()
    events: frozenset[str] | None = None

    def __and__(self, other: "KnownFacts") -> "KnownFacts":
        events = [k.events for k in (self, other) if k.events is not None]
        return KnownFacts(self.present | other.present, frozenset.intersection(*events) if events else None)


def facts(node: ExpressionNode, value: bool) -> KnownFacts:
    """What is made sure of where the condition has that value."""
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
    """The paths of what the node stands in."""
    found = set()
    while isinstance(node, FieldAccess | IndexAccess):
        node = node.base
        if path := path_of(node):
            found.add(path)
    return frozenset(found)
