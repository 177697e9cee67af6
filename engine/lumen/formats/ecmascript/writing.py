"""From our expressions to ECMAScript's, and what in them only Lumen knows."""

import re
from collections.abc import Mapping
from typing import NamedTuple

from lumen.formats.ecmascript.kinds import is_float, kind
from lumen.formats.ecmascript.methods import SAME
from lumen.formats.ecmascript.words import ScriptError
from lumen.interpreters.expressions import parse_expression, unparse
from lumen.interpreters.expressions.kinds import LIST, MAP, TEXT
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
    path_of,
)

_METHODS = {ours: theirs for theirs, ours in SAME.items()}
_PREFIX = re.compile(r"\^((?:\\[^\w\s]|[\w\s])+)", re.ASCII)
_SUFFIX = re.compile(r"((?:\\[^\w\s]|[\w\s])+)\$", re.ASCII)


class Written(NamedTuple):
    """The ECMAScript, and the names in it that other tools do not know."""

    text: str
    foreign: tuple[str, ...] = ()


class Vocabulary(NamedTuple):
    """What our names are there: the `kinds` that context keys keep, their names, and the ids of states by path."""

    kinds: Mapping[str, str] = {}
    keys: Mapping[str, str] = {}
    states: Mapping[str, str] = {}


def write_expression(source: str, vocabulary: Vocabulary) -> Written:
    """One of our expressions in ECMAScript; raises ScriptError where it uses the context or the event as a whole."""
    writer = _Writer(vocabulary)
    text = unparse(writer.node(parse_expression(source)))
    return Written(text, tuple(dict.fromkeys(writer.foreign)))


class _Writer:
    """Translates one tree; `foreign` collects what only Lumen knows."""

    def __init__(self, vocabulary: Vocabulary) -> None:
        self.vocabulary = vocabulary
        self.foreign: list[str] = []

    def kind(self, node: Node) -> str:
        return kind(node, self.vocabulary.kinds)

    def node(self, node: Node) -> Node:
        match node:
            case Literal():
                return node
            case Name(name=name):
                return self._name(name)
            case (
                Field(base=Name(name="context"), name=name)
                | Index(base=Name(name="context"), key=Literal(value=str() as name))
            ):
                return Name(self.vocabulary.keys.get(name, name))
            case Field(base=Name(name="event"), name=name):
                return Field(Name("_event"), name)
            case Field(base=base, name=name):
                return Field(self.node(base), name)
            case Index(base=base, key=key):
                return Index(self.node(base), self.node(key))
            case Items(items=items):
                return Items(tuple(map(self.node, items)))
            case Entries(keys=keys, values=values):
                return Entries(keys, tuple(map(self.node, values)))
            case Unary(sign="!", operand=Call(function="has", arguments=(target,))):
                return self._typeof("===", target)
            case Unary(sign=sign, operand=operand):
                return Unary(sign, self.node(operand))
            case Logic(sign=sign, operands=operands):
                return Logic(sign, tuple(map(self.node, operands)))
            case Choice(condition=condition, then=then, otherwise=otherwise):
                return Choice(*map(self.node, (condition, then, otherwise)))
            case Binary():
                return self._binary(node)
            case Call():
                return self._call(node)

    def _name(self, name: str) -> Node:
        if name != "state":
            raise ScriptError(f"`{name}` as a whole has no counterpart")
        self.foreign.append("state")
        return Field(Name("_x"), "state")

    def _binary(self, node: Binary) -> Node:
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
                return Call(".trunc", (Name("Math"), Binary("/", left, right)))
        return Binary(node.sign, left, right)

    def _contained(self, node: Binary, left: Node, right: Node) -> Node:
        match self.kind(node.right), self.kind(node.left):
            case "list", _:
                return Call(".includes", (right, left))
            case "map", "text":
                return Binary("in", left, right)
        return self._own("contained", left, right)

    def _call(self, node: Call) -> Node:
        arguments = tuple(map(self.node, node.arguments))
        match node.function, arguments:
            case "has", _:
                return self._typeof("!==", node.arguments[0])
            case "In", (Literal(value=str() as state),):
                return Call("In", (Literal(self.vocabulary.states.get(state, state)),))
            case "In", _:
                return Call("In", arguments)
            case "size", (value,) if self.kind(node.arguments[0]) != MAP:
                return Field(value, "length")
            case "contains", _ if TEXT in map(self.kind, node.arguments) and self.kind(node.arguments[0]) != LIST:
                return Call(".includes", arguments)
            case "matches", (value, Literal(value=str() as pattern)):
                for method, form in ((".startsWith", _PREFIX), (".endsWith", _SUFFIX)):
                    if found := form.fullmatch(pattern):
                        return Call(method, (value, Literal(re.sub(r"\\(.)", r"\1", found[1]))))
            case name, _ if name in _METHODS:
                return Call(_METHODS[name], arguments)
        return self._own(node.function, *arguments)

    def _typeof(self, sign: str, target: Node) -> Node:
        """Whether something is there; where an event's name is, there is an event."""
        asked = Name("_event") if path_of(target) == ("event", "name") else self.node(target)
        return Binary(sign, Unary("typeof", asked), Literal("undefined"))

    def _own(self, name: str, *arguments: Node) -> Node:
        self.foreign.append(name)
        return Call(name, arguments)
