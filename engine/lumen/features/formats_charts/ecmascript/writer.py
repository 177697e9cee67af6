"""Translates Lumen's expressions to ECMAScript, and collects the names in them that only Lumen has."""

import re
from collections.abc import Mapping
from typing import NamedTuple

from lumen.expressions import parse_expression, unparse
from lumen.expressions.kinds import LIST, MAP, TEXT
from lumen.expressions.readings import as_written
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
    path_of,
)
from lumen.features.formats_charts.ecmascript.kind_inference import is_float, kind
from lumen.features.formats_charts.ecmascript.methods import EQUIVALENT_METHODS
from lumen.features.formats_charts.ecmascript.script_parser import ScriptError

_METHODS = {ours: theirs for theirs, ours in EQUIVALENT_METHODS.items()}
_PREFIX = re.compile(r"\^((?:\\[^\w\s]|[\w\s])+)", re.ASCII)
_SUFFIX = re.compile(r"((?:\\[^\w\s]|[\w\s])+)\$", re.ASCII)


class WrittenScript(NamedTuple):
    """An ECMAScript expression, and the names in it that only Lumen has."""

    text: str
    foreign: tuple[str, ...] = ()


class Vocabulary(NamedTuple):
    """The document's names for Lumen's context keys and states, and the kinds of keys."""

    kinds: Mapping[str, str] = {}
    """The constant kinds of context keys."""
    keys: Mapping[str, str] = {}
    """The document's names of context keys, by Lumen's names."""
    states: Mapping[str, str] = {}
    """The document's ids of states, by Lumen's paths."""


def write_expression(source: str, vocabulary: Vocabulary) -> WrittenScript:
    """Translate a Lumen expression to ECMAScript.

    Raises ScriptError if the expression uses the context or the event as a whole.
    """
    writer = _ScriptWriter(vocabulary)
    text = unparse(writer.node(parse_expression(as_written(source))))
    return WrittenScript(text, tuple(dict.fromkeys(writer.foreign)))


class _ScriptWriter:
    """Translates one tree; `foreign` collects the names that only Lumen has."""

    def __init__(self, vocabulary: Vocabulary) -> None:
        self.vocabulary = vocabulary
        self.foreign: list[str] = []

    def kind(self, node: ExpressionNode) -> str:
        return kind(node, self.vocabulary.kinds)

    def node(self, node: ExpressionNode) -> ExpressionNode:
        match node:
            case Literal():
                return node
            case Identifier(name=name):
                return self._name(name)
            case (
                FieldAccess(base=Identifier(name="context"), name=name)
                | IndexAccess(base=Identifier(name="context"), key=Literal(value=str() as name))
            ):
                return Identifier(self.vocabulary.keys.get(name, name))
            case FieldAccess(base=Identifier(name="event"), name=name):
                return FieldAccess(Identifier("_event"), name)
            case FieldAccess(base=base, name=name):
                return FieldAccess(self.node(base), name)
            case IndexAccess(base=base, key=key):
                return IndexAccess(self.node(base), self.node(key))
            case ListLiteral(items=items):
                return ListLiteral(tuple(map(self.node, items)))
            case MapLiteral(keys=keys, values=values):
                return MapLiteral(keys, tuple(map(self.node, values)))
            case Unary(sign="!", operand=FunctionCall(function="has", arguments=(target,))):
                return self._typeof("===", target)
            case Unary(sign=sign, operand=operand):
                return Unary(sign, self.node(operand))
            case Logic(sign=sign, operands=operands):
                return Logic(sign, tuple(map(self.node, operands)))
            case Conditional(condition=condition, then=then, otherwise=otherwise):
                return Conditional(*map(self.node, (condition, then, otherwise)))
            case Binary():
                return self._binary(node)
            case FunctionCall():
                return self._call(node)

    def _name(self, name: str) -> ExpressionNode:
        if name not in ("state", "heard"):
            raise ScriptError(f"`{name}` as a whole has no counterpart in ECMAScript")
        self.foreign.append(name)
        return FieldAccess(Identifier("_x"), name)

    def _binary(self, node: Binary) -> ExpressionNode:
        left, right = self.node(node.left), self.node(node.right)
        match node.sign:
            case "==" | "!=":
                if {self.kind(node.left), self.kind(node.right)} & {LIST, MAP}:
                    call = self._own("same", left, right)
                    return call if node.sign == "==" else Unary("!", call)
                return Binary(f"{node.sign}=", left, right)
            case "in":
                return self._contained(node, left, right)
            case "/" if not (is_float(node.left) or is_float(node.right)):
                return FunctionCall(".trunc", (Identifier("Math"), Binary("/", left, right)))
        return Binary(node.sign, left, right)

    def _contained(self, node: Binary, left: ExpressionNode, right: ExpressionNode) -> ExpressionNode:
        match self.kind(node.right), self.kind(node.left):
            case "list", _:
                return FunctionCall(".includes", (right, left))
            case "map", "text":
                return Binary("in", left, right)
        return self._own("contained", left, right)

    def _call(self, node: FunctionCall) -> ExpressionNode:
        arguments = tuple(map(self.node, node.arguments))
        match node.function, arguments:
            case "has", _:
                return self._typeof("!==", node.arguments[0])
            case "In", (Literal(value=str() as state),):
                return FunctionCall("In", (Literal(self.vocabulary.states.get(state, state)),))
            case "In", _:
                return FunctionCall("In", arguments)
            case "size", (value,) if self.kind(node.arguments[0]) != MAP:
                return FieldAccess(value, "length")
            case "contains", _ if TEXT in map(self.kind, node.arguments) and self.kind(node.arguments[0]) != LIST:
                return FunctionCall(".includes", arguments)
            case "matches", (value, Literal(value=str() as pattern)):
                for method, form in ((".startsWith", _PREFIX), (".endsWith", _SUFFIX)):
                    if found := form.fullmatch(pattern):
                        return FunctionCall(method, (value, Literal(re.sub(r"\\(.)", r"\1", found[1]))))
            case name, _ if name in _METHODS:
                return FunctionCall(_METHODS[name], arguments)
        return self._own(node.function, *arguments)

    def _typeof(self, sign: str, target: ExpressionNode) -> ExpressionNode:
        """Translate a test that a value is present or, with `===`, missing; for `event.name`, `_event` is tested."""
        asked = Identifier("_event") if path_of(target) == ("event", "name") else self.node(target)
        return Binary(sign, Unary("typeof", asked), Literal("undefined"))

    def _own(self, name: str, *arguments: ExpressionNode) -> ExpressionNode:
        self.foreign.append(name)
        return FunctionCall(name, arguments)
