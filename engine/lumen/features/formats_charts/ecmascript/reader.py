"""Translates ECMAScript's trees to Lumen's. ScriptError means that an expression has no counterpart."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field

from lumen.expressions import unparse
from lumen.expressions.kinds import BOOLEAN, MAP, NUMBER, TEXT
from lumen.expressions.scope import MAX_EXPRESSION_LENGTH, MAX_INT, MAX_TREE_DEPTH, MIN_INT
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
    walk,
)
from lumen.features.formats_charts.ecmascript.equality import EVENT, HAPPENED, equality, guarded
from lumen.features.formats_charts.ecmascript.kind_inference import UNKNOWN_KIND, is_float, kind, known, negated
from lumen.features.formats_charts.ecmascript.methods import LUMEN_FUNCTIONS, SIGN_FUNCTIONS, method
from lumen.features.formats_charts.ecmascript.script_parser import ScriptError, parse_script

_IDENTIFIER = re.compile(r"[A-Za-z_]\w*", re.ASCII)
_FALSY = ListLiteral((Literal(None), Literal(False), Literal(0), Literal("")))


@dataclass(frozen=True)
class ScriptNames:
    """The meaning of a document's names."""

    context: Mapping[str, str] = field(default_factory=dict)
    """The context keys, by their names in the data model."""
    kinds: Mapping[str, str] = field(default_factory=dict)
    """The constant kinds of context keys; a key that is not listed can have any kind."""
    states: Mapping[str, str] = field(default_factory=dict)
    """Lumen's names of states, by the ids used in `In()`."""
    events: Mapping[str, str] = field(default_factory=dict)
    """Lumen's names of events, by the document's names, where they differ."""
    title: str = ""
    """The value of `_name`."""


def read_condition(source: str, names: ScriptNames) -> str:
    """Return a Lumen expression that is true if the source is truthy. Raises ScriptError if there is none."""
    return printed(ScriptTranslator(names).condition(parse_script(source)))


def read_value(source: str, names: ScriptNames) -> ExpressionNode:
    """Return a Lumen tree with the same value as the source. Raises ScriptError if there is none."""
    tree = ScriptTranslator(names).value(parse_script(source))
    printed(tree)
    return tree


def printed(tree: ExpressionNode) -> str:
    """Return the text of a Lumen tree.

    Raises ScriptError if the tree or its text exceeds the limit for expressions.
    """
    if any(level > MAX_TREE_DEPTH for _, level in walk(tree)):
        raise ScriptError("it is nested too deeply")
    text = unparse(tree)
    if len(text) > MAX_EXPRESSION_LENGTH:
        raise ScriptError(f"the converted expression is longer than {MAX_EXPRESSION_LENGTH:,} characters")
    return text


class ScriptTranslator:
    """Translates one expression; `present` has the event fields known to be present at the current operand."""

    def __init__(self, names: ScriptNames) -> None:
        self.names = names
        self.present: frozenset[tuple[str, ...]] = frozenset()

    def kind(self, node: ExpressionNode) -> str:
        """Return the kind of a Lumen tree's value, or UNKNOWN_KIND."""
        return kind(node, self.names.kinds)

    def condition(self, tree: ExpressionNode) -> ExpressionNode:
        """Return a Lumen tree that is true if an ECMAScript tree is truthy. Raises ScriptError if there is none."""
        match tree:
            case Logic(sign=sign, operands=operands):
                return self._logic(sign, operands)
            case Unary(sign="!", operand=operand):
                return negated(self.condition(operand))
            case Conditional(condition=condition, then=then, otherwise=otherwise):
                return Conditional(self.condition(condition), self.condition(then), self.condition(otherwise))
        return HAPPENED if tree == EVENT else self._truthy(self.value(tree))

    def _logic(self, sign: str, operands: tuple[ExpressionNode, ...]) -> ExpressionNode:
        before, found = self.present, list[ExpressionNode]()
        for operand in operands:
            read = self.condition(operand)
            same = isinstance(read, Logic) and read.sign == sign
            found += read.operands if same and isinstance(read, Logic) else (read,)
            self.present |= known(read, sign == "&&")
        self.present = before
        return Logic(sign, tuple(found))

    def _truthy(self, node: ExpressionNode) -> ExpressionNode:
        match self.kind(node):
            case "boolean":
                return node
            case "number":
                return Binary("!=", node, Literal(0))
            case "text":
                return Binary("!=", node, Literal(""))
            case "null":
                return Literal(False)
            case "list" | "map":
                return Literal(True)
        return guarded(self, Unary("!", Binary("in", node, _FALSY)), node)

    def value(self, tree: ExpressionNode) -> ExpressionNode:
        """Return a Lumen tree with an ECMAScript tree's value. Raises ScriptError if there is none."""
        match tree:
            case Literal(value=int() as value) if not isinstance(value, bool) and not MIN_INT <= value <= MAX_INT:
                return Literal(float(value))
            case Literal():
                return tree
            case Identifier(name=name):
                return self._name(name)
            case FieldAccess(base=base, name=name) | IndexAccess(base=base, key=Literal(value=str() as name)):
                return self._field(base, name)
            case IndexAccess(base=base, key=key):
                return IndexAccess(self.value(base), self.value(key))
            case ListLiteral(items=items):
                return ListLiteral(tuple(map(self.value, items)))
            case MapLiteral(keys=keys, values=values):
                return MapLiteral(keys, tuple(map(self.value, values)))
            case Unary():
                return self._unary(tree)
            case Binary():
                return self._binary(tree)
            case Logic():
                return self._either(tree)
            case Conditional(condition=condition, then=then, otherwise=otherwise):
                return Conditional(self.condition(condition), self.value(then), self.value(otherwise))
            case FunctionCall():
                return self._call(tree)

    def _name(self, name: str) -> ExpressionNode:
        if name in self.names.context:
            return FieldAccess(Identifier("context"), self.names.context[name])
        if name == "undefined":
            return Literal(None)
        if name == "_name":
            return Literal(self.names.title)
        if name in ("_event", "_sessionid", "_ioprocessors", "_x"):
            raise ScriptError(f"`{name}` as a whole has no counterpart in Lumen")
        raise ScriptError(f"`{name}` is not declared in a `<datamodel>`")

    def _field(self, base: ExpressionNode, name: str) -> ExpressionNode:
        if base == EVENT:
            if name not in ("name", "data"):
                raise ScriptError(f"events in Lumen have no `{name}`, only `name` and `data`")
            return FieldAccess(Identifier("event"), name)
        if base == Identifier("_x") and name in ("state", "heard"):
            return Identifier(name)
        if isinstance(base, Identifier) and base.name in ("_ioprocessors", "_x", "Math"):
            raise ScriptError(f"`{base.name}.{name}` has no counterpart in Lumen")
        read = self.value(base)
        if name == "length" and self.kind(read) != MAP:
            return FunctionCall("size", (read,))
        return FieldAccess(read, name) if _IDENTIFIER.fullmatch(name) else IndexAccess(read, Literal(name))

    def _unary(self, node: Unary) -> ExpressionNode:
        if node.sign == "!":
            return self.condition(node)
        if node.sign == "typeof":
            raise ScriptError("`typeof` can only be compared with 'undefined'")
        read = self.value(node.operand)
        if self.kind(read) not in (NUMBER, UNKNOWN_KIND) or (node.sign == "+" and self.kind(read) != NUMBER):
            raise ScriptError(f"`{node.sign}` would convert a value to a number")
        return read if node.sign == "+" else Unary("-", read)

    def _either(self, node: Logic) -> ExpressionNode:
        """Translate `a || b` or `a && b`, whose value is one of the operands, not always a boolean."""
        values = [self.value(operand) for operand in node.operands]
        if all(self.kind(value) == BOOLEAN for value in values):
            return self._logic(node.sign, node.operands)
        *before, result = values
        for value in reversed(before):
            yes, no = (result, value) if node.sign == "&&" else (value, result)
            result = Conditional(self._truthy(value), yes, no)
        return result

    def _binary(self, node: Binary) -> ExpressionNode:
        sign = node.sign
        if sign in ("==", "===", "!=", "!=="):
            return equality(self, self._renamed(node))
        left, right = self.value(node.left), self.value(node.right)
        if sign in ("<", "<=", ">", ">="):
            self._same_kind(sign, left, right, (NUMBER, TEXT))
            return guarded(self, Binary(sign, left, right), left, right)
        if sign == "in":
            if self.kind(left) != TEXT:
                raise ScriptError("`in` needs a key in quotes before it")
            return Binary("in", left, right)
        self._same_kind(sign, left, right, (NUMBER, TEXT) if sign == "+" else (NUMBER,))
        if sign == "/" and not (is_float(left) or is_float(right)):
            left, right = _floats(left, right)
        return Binary(sign, left, right)

    def _renamed(self, node: Binary) -> Binary:
        """Return a comparison with `_event.name` using Lumen's event name, and any other comparison unchanged."""
        name = FieldAccess(EVENT, "name")
        match node.left, node.right:
            case left, Literal(value=str() as event) if left == name:
                return Binary(node.sign, left, Literal(self.names.events.get(event, event)))
            case Literal(value=str() as event), right if right == name:
                return Binary(node.sign, Literal(self.names.events.get(event, event)), right)
        return node

    def _same_kind(self, sign: str, left: ExpressionNode, right: ExpressionNode, allowed: tuple[str, ...]) -> None:
        kinds = {self.kind(left), self.kind(right)} - {UNKNOWN_KIND}
        if not kinds <= set(allowed) or len(kinds) > 1:
            raise ScriptError(f"`{sign}` joins values of different types, which ECMAScript would convert")

    def _call(self, node: FunctionCall) -> ExpressionNode:
        if node.function == "In":
            return self._in(node)
        if node.function.startswith("."):
            return method(self, node)
        if node.function not in LUMEN_FUNCTIONS:
            raise ScriptError(f"`{node.function}()` has no counterpart in Lumen")
        arguments = tuple(map(self.value, node.arguments))
        if node.function in SIGN_FUNCTIONS and len(arguments) == 2:
            return Binary(SIGN_FUNCTIONS[node.function], *arguments)
        return FunctionCall(node.function, arguments)

    def _in(self, node: FunctionCall) -> ExpressionNode:
        """Translate `In('id')`, and `In(id)` from the data model `null` (SCXML B.1.2); an unknown literal is false."""
        states = self.names.states
        match node.arguments:
            case (Literal(value=str() as state),):
                return FunctionCall("In", (Literal(states[state]),)) if state in states else Literal(False)
            case (Literal(),):
                return Literal(False)
            case (Identifier(name=state),) if state in states and state not in self.names.context:
                return FunctionCall("In", (Literal(states[state]),))
            case (state,):
                return FunctionCall("In", (self.value(state),))
        raise ScriptError("`In` needs the id of a state")


def _floats(left: ExpressionNode, right: ExpressionNode) -> tuple[ExpressionNode, ExpressionNode]:
    """Return the operands of `/` with one as a float: Lumen's division of integers drops the fraction."""
    match left, right:
        case _, Literal(value=int() as value):
            return left, Literal(float(value))
        case Literal(value=int() as value), _:
            return Literal(float(value)), right
    return Binary("*", Literal(1.0), left), right
