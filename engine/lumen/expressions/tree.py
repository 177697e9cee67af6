"""The tree of an expression: frozen nodes with their places in the source."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from typing import NamedTuple


@dataclass(frozen=True, slots=True, kw_only=True)
class SourceSpan:
    """The place of a node in the source, as offsets in characters; it does not count in equality."""

    offset: int = field(default=0, compare=False)
    """The offset of the first character."""
    end: int = field(default=0, compare=False)
    """The offset after the last character."""


@dataclass(frozen=True, slots=True)
class Literal(SourceSpan):
    """A number, a text, true, false or null."""

    value: int | float | str | bool | None


@dataclass(frozen=True, slots=True)
class Identifier(SourceSpan):
    """The beginning of a path: `context`, `event`, `state`, `lists`, or the name of a variable."""

    name: str


@dataclass(frozen=True, slots=True)
class FieldAccess(SourceSpan):
    """`base.name`; the name ends where the node ends."""

    base: "ExpressionNode"
    name: str


@dataclass(frozen=True, slots=True)
class IndexAccess(SourceSpan):
    """`base[key]`."""

    base: "ExpressionNode"
    key: "ExpressionNode"


@dataclass(frozen=True, slots=True)
class ListLiteral(SourceSpan):
    """`[items]`."""

    items: tuple["ExpressionNode", ...]


@dataclass(frozen=True, slots=True)
class MapLiteral(SourceSpan):
    """`{'key': value}`."""

    keys: tuple[str, ...]
    values: tuple["ExpressionNode", ...]


@dataclass(frozen=True, slots=True)
class Unary(SourceSpan):
    """`!operand` or `-operand`."""

    sign: str
    operand: "ExpressionNode"


@dataclass(frozen=True, slots=True)
class Binary(SourceSpan):
    """`left sign right`, for comparison, arithmetic and `in`."""

    sign: str
    left: "ExpressionNode"
    right: "ExpressionNode"


@dataclass(frozen=True, slots=True)
class Logic(SourceSpan):
    """Two or more operands joined by `&&`, or by `||`."""

    sign: str
    operands: tuple["ExpressionNode", ...]


@dataclass(frozen=True, slots=True)
class Conditional(SourceSpan):
    """`condition ? then : otherwise`."""

    condition: "ExpressionNode"
    then: "ExpressionNode"
    otherwise: "ExpressionNode"


@dataclass(frozen=True, slots=True)
class FunctionCall(SourceSpan):
    """`function(arguments)`, or `first.function(rest)`."""

    function: str
    arguments: tuple["ExpressionNode", ...]
    named: int = field(default=0, compare=False)
    """The offset of the function's name."""


ExpressionNode = (
    Literal
    | Identifier
    | FieldAccess
    | IndexAccess
    | ListLiteral
    | MapLiteral
    | Unary
    | Binary
    | Logic
    | Conditional
    | FunctionCall
)


def children(node: ExpressionNode) -> tuple[ExpressionNode, ...]:
    """Return the child nodes, in the order written."""
    match node:
        case FieldAccess(base=base):
            return (base,)
        case IndexAccess(base=base, key=key):
            return (base, key)
        case (
            ListLiteral(items=nodes) | MapLiteral(values=nodes) | Logic(operands=nodes) | FunctionCall(arguments=nodes)
        ):
            return nodes
        case Unary(operand=operand):
            return (operand,)
        case Binary(left=left, right=right):
            return (left, right)
        case Conditional(condition=condition, then=then, otherwise=otherwise):
            return (condition, then, otherwise)
    return ()


def rebuilt(node: ExpressionNode, change: Callable[[ExpressionNode], ExpressionNode]) -> ExpressionNode:
    """Return the node with each child replaced by the result of `change` for this child."""
    match node:
        case FieldAccess(base=base):
            return replace(node, base=change(base))
        case IndexAccess(base=base, key=key):
            return replace(node, base=change(base), key=change(key))
        case ListLiteral(items=items):
            return replace(node, items=tuple(map(change, items)))
        case MapLiteral(values=values):
            return replace(node, values=tuple(map(change, values)))
        case Unary(operand=operand):
            return replace(node, operand=change(operand))
        case Binary(left=left, right=right):
            return replace(node, left=change(left), right=change(right))
        case Logic(operands=operands):
            return replace(node, operands=tuple(map(change, operands)))
        case Conditional(condition=condition, then=then, otherwise=otherwise):
            return replace(node, condition=change(condition), then=change(then), otherwise=change(otherwise))
        case FunctionCall(arguments=arguments):
            return replace(node, arguments=tuple(map(change, arguments)))
    return node


def walk(tree: ExpressionNode) -> Iterator[tuple[ExpressionNode, int]]:
    """Yield every node of the tree with its level, parents first; the root's level is 1."""
    stack = [(tree, 1)]
    while stack:
        node, level = stack.pop()
        yield node, level
        stack.extend((child, level + 1) for child in reversed(children(node)))


def path_of(node: ExpressionNode) -> tuple[str, ...] | None:
    """Return `("event", "data", "x")` for `event.data.x` and `event.data['x']`; None for other nodes."""
    keys: list[str] = []
    while not isinstance(node, Identifier):
        match node:
            case FieldAccess(base=base, name=name):
                key = name
            case IndexAccess(base=base, key=Literal(value=str() as key)):
                pass
            case _:
                return None
        keys.append(key)
        node = base
    return (node.name, *reversed(keys))


class MentionedNames(NamedTuple):
    """The names in an expression."""

    context: frozenset[str]
    """Keys of the context."""
    event: frozenset[str]
    """Fields of the event's data."""
    functions: frozenset[str]
    phrases: frozenset[str]
    """Literal names of phrases in `heard`."""
    answers: frozenset[str]
    """Literal names of answers in `lookup`."""
    states: frozenset[str]
    """Literal names of states in `In`."""


def names(tree: ExpressionNode) -> MentionedNames:
    """Return all names in the expression, for lint rules across files."""
    nodes = [node for node, _ in walk(tree)]
    paths = [path for node in nodes if (path := path_of(node))]
    calls = [node for node in nodes if isinstance(node, FunctionCall)]

    def literals(function: str, position: int) -> frozenset[str]:
        found = (c.arguments[position] for c in calls if c.function == function and len(c.arguments) > position)
        return frozenset(a.value for a in found if isinstance(a, Literal) and isinstance(a.value, str))

    return MentionedNames(
        frozenset(p[1] for p in paths if p[0] == "context" and len(p) > 1),
        frozenset(p[2] for p in paths if p[:2] == ("event", "data") and len(p) > 2),
        frozenset(c.function for c in calls),
        literals("heard", 1),
        literals("lookup", 1),
        literals("In", 0),
    )
