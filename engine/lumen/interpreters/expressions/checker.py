"""What can be told of an expression before it runs: unknown names, and kinds that can never go together."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

from lumen.errors import ExpressionError
from lumen.interpreters.expressions.functions import FUNCTIONS, Function
from lumen.interpreters.expressions.parser import parse_expression
from lumen.interpreters.expressions.patterns import compile_pattern
from lumen.interpreters.expressions.schemas import ANY, Presence, Type, of, type_of_schema, type_of_values, union
from lumen.interpreters.expressions.scope import ROOTS
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
    children,
    path_of,
)  # fmt: skip
from lumen.interpreters.expressions.values import BOOLEAN, IN_WORDS, KINDS, LIST, MAP, NULL, NUMBER, TEXT
from lumen.language.diagnostics import did_you_mean


class Finding(NamedTuple):
    """A fault of an expression: `offset` and `length` [characters] say where in its source."""

    code: str
    offset: int
    length: int
    message: str
    hint: str = ""


@dataclass(frozen=True)
class Surroundings:
    """What is declared around an expression; None where that is not known.

    `context` and `events` hold JSON Schemas, of the keys and of the events' data (None: of any kind).
    """

    context: Mapping[str, Any] | None = None
    events: Mapping[str, Any] | None = None
    phrases: Iterable[str] | None = None
    answers: Iterable[str] | None = None
    states: Iterable[str] | None = None


class Known(NamedTuple):
    """What the conditions around a node make sure of: fields that are there, and which events it can be."""

    present: frozenset[tuple[str, ...]] = frozenset()
    events: frozenset[str] | None = None

    def __and__(self, other: "Known") -> "Known":
        events = [k.events for k in (self, other) if k.events is not None]
        return Known(self.present | other.present, frozenset.intersection(*events) if events else None)


STRUCTURAL = frozenset(("unknown-name", "unknown-function", "wrong-argument-count", "unsafe-pattern", "wrong-argument"))
"""The codes of what can't even be compiled."""

_INSTEAD = {
    "len": "size", "length": "size", "count": "size", "lowerAscii": "lower", "toLower": "lower", "strip": "trim",
    "includes": "contains", "in": "In", "regex": "matches", "split": "words", "startsWith": "matches",
    "endsWith": "matches",
}  # fmt: skip


def must_hold(tree: Node) -> None:
    """Raise ExpressionError for the first thing that keeps the expression from being compiled."""
    checker = _Checker(Surroundings())
    checker.type(tree, Known())
    for finding in checker.findings:
        if finding.code in STRUCTURAL:
            raise ExpressionError(finding.message, finding.offset, finding.hint)


def check_tree(tree: Node, around: Surroundings, expected: Mapping[str, Any] | None = None) -> list[Finding]:
    """Everything wrong with a tree; `expected` is the JSON Schema that its value has to fit."""
    checker = _Checker(around)
    result = checker.type(tree, Known())
    if expected is not None:
        checker.expect(tree, result, type_of_schema(expected).kinds, "here")
    return sorted(checker.findings, key=lambda finding: finding.offset)


def check_expression(
    source: str,
    *,
    context: Mapping[str, Any] | None,
    events: Mapping[str, Any] | None = None,
    phrases: Iterable[str] | None = None,
    answers: Iterable[str] | None = None,
    states: Iterable[str] | None = None,
    expected: Mapping[str, Any] | None = None,
) -> list[Finding]:
    """Everything wrong with an expression, in the order it stands; never raises for what the source says.

    `context` maps its keys to JSON Schemas; `events` maps the events that can arrive here to those of their data
    (None: of any kind), and is None where any event can. `phrases`, `answers` and `states` are the names there are,
    None where that is not known. `expected` is the schema that the value has to fit: `{"type": "boolean"}` for a
    guard.
    """
    try:
        tree = parse_expression(source)
    except ExpressionError as error:
        return [Finding("expression-syntax", error.offset, 1, error.message, error.hint)]
    return check_tree(tree, Surroundings(context, events, phrases, answers, states), expected)


class _Checker:
    """Finds the type of every node from below, and collects what is wrong on the way."""

    def __init__(self, around: Surroundings) -> None:
        self.around = around
        self.findings: list[Finding] = []

    def report(self, code: str, node: Node, message: str, hint: str = "", offset: int | None = None) -> None:
        start = node.offset if offset is None else offset
        finding = Finding(code, start, max(1, node.end - start), message, hint)
        if finding not in self.findings:
            self.findings.append(finding)

    def expect(self, node: Node, found: Type, wanted: frozenset[str], whose: str) -> bool:
        """Whether the value can be of a kind that is wanted, saying so where it can't."""
        if found.kinds & wanted:
            return True
        needs = " or ".join(IN_WORDS[k] for k in IN_WORDS if k in wanted)
        self.report("type-mismatch", node, f"this is {_kinds(found)}, and {needs} is needed {whose}")
        return False

    def type(self, node: Node, known: Known) -> Type:
        match node:
            case Literal(value=value):
                return type_of_values([value])
            case Name():
                return self.name(node, known)
            case Field() | Index():
                return self.member(node, known)
            case Items() | Entries():
                for child in children(node):
                    self.type(child, known)
                return of(LIST if isinstance(node, Items) else MAP)
            case Unary(sign=sign, operand=operand):
                kind = BOOLEAN if sign == "!" else NUMBER
                self.expect(operand, self.type(operand, known), frozenset((kind,)), f"by `{sign}`")
                return of(kind)
            case Logic(sign=sign, operands=operands):
                for operand in operands:
                    self.expect(operand, self.type(operand, known), frozenset((BOOLEAN,)), f"by `{sign}`")
                    known &= facts(operand, sign == "&&")
                return of(BOOLEAN)
            case Choice(condition=condition, then=then, otherwise=otherwise):
                self.expect(condition, self.type(condition, known), frozenset((BOOLEAN,)), "before `?`")
                yes = self.type(then, known & facts(condition, True))
                return union((yes, self.type(otherwise, known & facts(condition, False))))
            case Binary():
                return self.binary(node, self.type(node.left, known), self.type(node.right, known))
            case Call():
                return self.call(node, known)

    def name(self, node: Name, known: Known) -> Type:
        around = self.around
        if node.name == "context":
            properties = around.context
            return ANY if properties is None else Type(frozenset((MAP,)), ({"properties": properties},))
        if node.name == "event":
            return self.event(known)
        if node.name == "state":
            text = {"type": "string"}
            return Type(frozenset((MAP,)), ({"properties": {"path": text, "language": text}},))
        hint = did_you_mean(node.name, ROOTS, "an expression begins with")
        if around.context and node.name in around.context:
            hint = f"did you mean `context.{node.name}`?"
        elif node.name in FUNCTIONS:
            hint = f"write `{node.name}(…)`"
        else:
            hint += f"; a text stands in quotes: '{node.name}'"
        self.report("unknown-name", node, f"there is nothing named `{node.name}`", hint)
        return ANY

    def event(self, known: Known) -> Type:
        events = self.around.events
        if events is None:
            return Type(frozenset((MAP, NULL)), ({"properties": {"name": {"type": "string"}, "data": {}}},))
        possible = [name for name in events if known.events is None or name in known.events]
        name = {"type": "string"}
        data = [events[n] if isinstance(events[n], Mapping) else {} for n in possible]
        return Type(frozenset((MAP,)), tuple({"properties": {"name": name, "data": d}} for d in data))

    def member(self, node: Field | Index, known: Known, *, must_exist: bool = True) -> Type:
        base = self.type(node.base, known)
        match node:
            case Field(name=key) | Index(key=Literal(value=str() as key)):
                pass
            case Index(key=index):
                return self.index(node, base, self.type(index, known))
        if not self.expect(node.base, base, frozenset((MAP,)), f"to have `{key}`"):
            return ANY
        found, presence = base.field(key)
        path = path_of(node)
        if must_exist or path in (None, ("context", key)):
            self.presence(node, key, base, presence, path in known.present)
        return found

    def index(self, node: Index, base: Type, index: Type) -> Type:
        indexed = {LIST: NUMBER, MAP: TEXT}
        if self.expect(node.base, base, frozenset(indexed), "before `[`"):
            wanted = frozenset(indexed[kind] for kind in base.kinds if kind in indexed)
            self.expect(node.key, index, wanted, "as an index")
        return base.element() if base.kinds == {LIST} else ANY

    def presence(self, node: Field | Index, key: str, base: Type, presence: Presence, guarded: bool) -> None:
        """Report a field that is not there, or may be missing."""
        start = node.end - len(key) if isinstance(node, Field) else node.key.offset
        path = path_of(node) or ()
        owner = ".".join(path[:-1]) or "this"
        if path[:1] == ("context",) and len(path) == 2 and presence is Presence.UNDECLARED:
            hint = did_you_mean(key, base.fields(), "`context` has")
            self.report("unknown-context-key", node, f"the context has no `{key}`", hint, start)
        elif guarded or presence is Presence.SURE:
            return
        elif presence is Presence.UNDECLARED:
            hint = did_you_mean(key, base.fields(), f"`{owner}` has")
            several = base.fields() and key in base.fields()
            message = f"not every event here has `{owner}.{key}`" if several else f"`{owner}` has no `{key}`"
            hint = f"guard it with has({owner}.{key})" if several else hint
            self.report("unknown-field", node, message, hint, start)
        else:
            hint = f"guard it with has({owner}.{key})"
            self.report("unguarded-field", node, f"`{owner}.{key}` may be missing", hint, start)

    def binary(self, node: Binary, left: Type, right: Type) -> Type:
        match node.sign:
            case "==" | "!=":
                apart = not left.kinds & right.kinds and NULL not in left.kinds | right.kinds
                if apart or (not left.kinds & right.kinds and {*left.kinds, *right.kinds} - {NULL} == set()):
                    answer = "false" if node.sign == "==" else "true"
                    self.mismatch(node, left, right, f"this is always {answer}")
                return of(BOOLEAN)
            case "<" | "<=" | ">" | ">=":
                if not left.kinds & right.kinds & {NUMBER, TEXT, BOOLEAN}:
                    self.mismatch(node, left, right, "compare two numbers, or two texts")
                return of(BOOLEAN)
            case "in":
                if self.expect(node.right, right, frozenset((LIST, MAP)), "after `in`") and right.kinds == {MAP}:
                    self.expect(node.left, left, frozenset((TEXT,)), "as the key of a map")
                return of(BOOLEAN)
            case "+":
                common = left.kinds & right.kinds & {NUMBER, TEXT, LIST}
                if not common:
                    self.mismatch(node, left, right, "`+` joins two numbers, two texts or two lists")
                return Type(common or KINDS)
        for operand, found in ((node.left, left), (node.right, right)):
            self.expect(operand, found, frozenset((NUMBER,)), f"by `{node.sign}`")
        return of(NUMBER)

    def mismatch(self, node: Binary, left: Type, right: Type, hint: str) -> None:
        message = f"{_kinds(left)} and {_kinds(right)} don't go together in `{node.sign}`"
        self.report("type-mismatch", node, message, hint)

    def call(self, node: Call, known: Known) -> Type:
        function = FUNCTIONS.get(node.function)
        if function is None:
            for argument in node.arguments:
                self.type(argument, known)
            similar = _INSTEAD.get(node.function)
            hint = f"did you mean `{similar}`?" if similar else did_you_mean(node.function, FUNCTIONS, "there are")
            self.report("unknown-function", node, f"there is no function `{node.function}`", hint, node.named)
            return ANY
        if len(node.arguments) != len(function.parameters):
            wanted, given = len(function.parameters), len(node.arguments)
            message = f"`{node.function}` takes {wanted or 'no'} argument{'s' * (wanted != 1)}, and here are {given}"
            self.report("wrong-argument-count", node, message, f"write `{_usage(node.function)}`")
        elif node.function == "has":
            return self.has(node, known)
        for argument, kinds in zip(node.arguments, function.parameters, strict=False):
            self.expect(argument, self.type(argument, known), kinds, f"by `{node.function}`")
        self.literal(node, function)
        return Type(function.returns)

    def has(self, node: Call, known: Known) -> Type:
        target = node.arguments[0]
        if isinstance(target, Field | Index):
            self.member(target, known & Known(_prefixes(target)), must_exist=False)
        else:
            self.report("wrong-argument", target, "`has` asks whether a field is there", "write `has(event.data.x)`")
        return of(BOOLEAN)

    def literal(self, node: Call, function: Function) -> None:
        """Look the literal names up that `heard`, `lookup` and `In` are given, and read the pattern of `matches`."""
        if len(node.arguments) != len(function.parameters) or not node.arguments:
            return
        last = node.arguments[-1]
        name = last.value if isinstance(last, Literal) and isinstance(last.value, str) else None
        around = self.around
        match node.function:
            case "matches":
                self.pattern(last, name)
            case "heard" if name is not None:
                self.named(last, name, "unknown-phrase", "phrases", around.phrases)
            case "lookup" if name is not None:
                self.named(last, name, "unknown-answers", "answers", around.answers)
            case "In" if name is not None:
                self.named(last, name, "unknown-state", "state", around.states)

    def named(self, node: Node, name: str, code: str, what: str, names: Iterable[str] | None) -> None:
        listed = None if names is None else set(names)
        if listed is not None and name not in listed:
            there = f"there is no state `{name}`" if what == "state" else f"there are no {what} named `{name}`"
            self.report(code, node, there, did_you_mean(name, listed, "there are"))

    def pattern(self, node: Node, pattern: str | None) -> None:
        if pattern is None:
            hint = "a pattern can't be computed; use `contains` for that"
            self.report("unsafe-pattern", node, "`matches` needs its pattern written as a text", hint)
            return
        try:
            compile_pattern(pattern)
        except ExpressionError as error:
            self.report("unsafe-pattern", node, f"in the pattern, {error.message}", error.hint)


def facts(node: Node, value: bool) -> Known:
    """What is made sure of where the condition has that value."""
    match node:
        case Unary(sign="!", operand=operand):
            return facts(operand, not value)
        case Logic(sign=sign, operands=operands) if (sign == "&&") == value:
            known = Known()
            for operand in operands:
                known &= facts(operand, value)
            return known
        case Call(function="has", arguments=(target,)) if value:
            path = path_of(target)
            return Known(_prefixes(target) | {path} if path else frozenset())
        case Binary(sign=sign, left=left, right=Literal(value=str() as name)) if sign == ("==" if value else "!="):
            return Known(events=frozenset((name,))) if path_of(left) == ("event", "name") else Known()
    return Known()


def _prefixes(node: Node) -> frozenset[tuple[str, ...]]:
    """The paths of what the node stands in."""
    found = set()
    while isinstance(node, Field | Index):
        node = node.base
        if path := path_of(node):
            found.add(path)
    return frozenset(found)


def _kinds(found: Type) -> str:
    return " or ".join(words for kind, words in IN_WORDS.items() if kind in found.kinds)


def _usage(name: str) -> str:
    usages = {"size": "text", "has": "event.data.x", "hour": "", "In": "'state'", "contains": "text, 'part'",
              "replace": "text, 'old', 'new'", "after": "text, 'phrase'", "matches": "text, 'pattern'",
              "heard": "text, 'name'", "lookup": "text, 'table'"}  # fmt: skip
    return f"{name}({usages.get(name, 'text')})"
