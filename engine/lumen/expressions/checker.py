"""Static checks of expressions: unknown names, and types that can never be combined."""

from collections.abc import Collection, Mapping
from types import MappingProxyType
from typing import Any

from lumen.errors import ExpressionError
from lumen.expressions.calls import check_names, check_purity, function_of
from lumen.expressions.expression_findings import (
    CODES_OF_COMPILE_ERRORS,
    EXPRESSION_SYNTAX,
    IMPURE_FUNCTION,
    TYPE_MISMATCH,
    UNGUARDED_FIELD,
    UNKNOWN_CONTEXT_KEY,
    UNKNOWN_FIELD,
    UNKNOWN_NAME,
    WRONG_ARGUMENT,
    Declarations,
    ExpressionFinding,
    ExpressionFindings,
    in_words,
)
from lumen.expressions.facts import KnownFacts, facts, prefixes
from lumen.expressions.function_table import functions
from lumen.expressions.kinds import BOOLEAN, KINDS, LIST, MAP, NULL, NUMBER, TEXT
from lumen.expressions.own_functions import KnownFunctions, OwnFunction
from lumen.expressions.parser import parse_expression
from lumen.expressions.printer import unparse
from lumen.expressions.scope import ROOTS
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
    children,
    path_of,
)
from lumen.expressions.value_types import (
    ANY,
    FieldPresence,
    ValueType,
    of,
    type_of_schema,
    type_of_values,
    union,
)
from lumen.language.diagnostics import did_you_mean, nearest


def must_hold(tree: ExpressionNode) -> None:
    """Raise ExpressionError for the first fault that keeps the expression from being compiled."""
    checker = _Checker(Declarations())
    checker.type(tree, KnownFacts())
    for finding in checker.findings.found:
        if finding.code in CODES_OF_COMPILE_ERRORS:
            raise ExpressionError(finding.message, finding.offset, finding.hint)


def check_tree(
    tree: ExpressionNode, around: Declarations, expected: Mapping[str, Any] | None = None
) -> list[ExpressionFinding]:
    """Return all findings about a tree, in order; `expected` is the JSON Schema for its value."""
    checker = _Checker(around)
    result = checker.type(tree, KnownFacts())
    if expected is not None:
        checker.expect(tree, result, type_of_schema(expected).kinds, "here")
    return sorted(checker.findings.found, key=lambda finding: finding.offset)


def kinds_of(tree: ExpressionNode, around: Declarations) -> frozenset[str]:
    """Return the kinds that the value of a tree can have."""
    return _Checker(around).type(tree, KnownFacts()).kinds


def check_expression(
    source: str,
    *,
    context: Mapping[str, Any] | None,
    events: Mapping[str, Any] | None = None,
    phrases: Collection[str] | None = None,
    answers: Collection[str] | None = None,
    states: Collection[str] | None = None,
    lists: Mapping[str, Any] | None = None,
    variables: Mapping[str, Any] | None = None,
    functions: KnownFunctions = MappingProxyType({}),
    expected: Mapping[str, Any] | None = None,
) -> list[ExpressionFinding]:
    """Return all findings about an expression, in the order of the source; a malformed source is a finding.

    `context` maps its keys to JSON Schemas. `events` maps the events that can arrive here to the schemas of their data
    (None for data of any kind); it is None if any event can arrive. `phrases`, `answers` and `states` are the existing
    names, or None if they are unknown. `lists` and `variables` (names of list entries) map names to JSON Schemas.
    `functions` are those of the project. `expected` is the schema of the value: `{"type": "boolean"}` for a guard.
    """
    try:
        tree = parse_expression(source)
    except ExpressionError as error:
        return [ExpressionFinding(EXPRESSION_SYNTAX, error.offset, 1, error.message, error.hint)]
    around = Declarations(context, events, phrases, answers, states, lists, variables or {}, functions)
    return check_tree(tree, around, expected)


class _Checker:
    """Infers the type of every node, bottom up, and collects findings on the way."""

    def __init__(self, around: Declarations) -> None:
        self.around, self.findings = around, ExpressionFindings()
        self.report = self.findings.report

    def expect(self, node: ExpressionNode, found: ValueType, wanted: frozenset[str], whose: str) -> bool:
        return self.findings.expect(node, found.kinds, wanted, whose)

    def type(self, node: ExpressionNode, known: KnownFacts) -> ValueType:
        match node:
            case Literal(value=value):
                return type_of_values([value])
            case Identifier():
                return self.name(node, known)
            case FieldAccess() | IndexAccess():
                return self.member(node, known)
            case ListLiteral() | MapLiteral():
                for child in children(node):
                    self.type(child, known)
                return of(LIST if isinstance(node, ListLiteral) else MAP)
            case Unary(sign=sign, operand=operand):
                kind = BOOLEAN if sign == "!" else NUMBER
                self.expect(operand, self.type(operand, known), frozenset((kind,)), f"by `{sign}`")
                return of(kind)
            case Logic(sign=sign, operands=operands):
                for operand in operands:
                    self.expect(operand, self.type(operand, known), frozenset((BOOLEAN,)), f"by `{sign}`")
                    known &= facts(operand, sign == "&&")
                return of(BOOLEAN)
            case Conditional(condition=condition, then=then, otherwise=otherwise):
                self.expect(condition, self.type(condition, known), frozenset((BOOLEAN,)), "before `?`")
                yes = self.type(then, known & facts(condition, True))
                return union((yes, self.type(otherwise, known & facts(condition, False))))
            case Binary():
                return self.binary(node, self.type(node.left, known), self.type(node.right, known))
            case FunctionCall():
                return self.call(node, known)

    def name(self, node: Identifier, known: KnownFacts) -> ValueType:
        around = self.around
        if around.pure:
            return self.argument(node)
        if node.name == "context":
            properties = around.context
            return ANY if properties is None else ValueType(frozenset((MAP,)), ({"properties": properties},))
        if node.name == "event":
            return self.event(known)
        if node.name == "state":
            text = {"type": "string"}
            return ValueType(frozenset((MAP,)), ({"properties": {"path": text, "language": text, "place": text}},))
        if node.name == "lists":
            return ANY if around.lists is None else ValueType(frozenset((MAP,)), ({"properties": around.lists},))
        if node.name in around.variables:
            return type_of_schema(around.variables[node.name])
        hint = did_you_mean(node.name, (*ROOTS, *around.variables), "an expression begins with")
        if around.context and node.name in around.context:
            hint = f"did you mean `context.{node.name}`?"
        elif around.lists and node.name in around.lists and not nearest(node.name, around.variables):
            hint = f"did you mean `lists.{node.name}`?"
        elif node.name in functions() or node.name in around.functions:
            hint = f"write `{node.name}(…)`"
        else:
            hint += f"; put a text in quotes: '{node.name}'"
        self.report(UNKNOWN_NAME, node, f"there is no name `{node.name}`", hint)
        return ANY

    def argument(self, node: Identifier) -> ValueType:
        """Return the type of a name in a function of the project; report a name that is not one of its arguments."""
        arguments = self.around.variables
        if node.name in arguments:
            return type_of_schema(arguments[node.name])
        if node.name in ROOTS:
            hint = "add an argument to `args`, and pass the value in each call"
            self.report(IMPURE_FUNCTION, node, f"a function can't read `{node.name}`", hint)
            return ANY
        hint = did_you_mean(node.name, arguments, "the arguments are") if arguments else "declare it in `args`"
        if not nearest(node.name, arguments):
            hint += f"; put a text in quotes: '{node.name}'"
        self.report(UNKNOWN_NAME, node, f"there is no argument `{node.name}`", hint)
        return ANY

    def event(self, known: KnownFacts) -> ValueType:
        events = self.around.events
        if events is None:
            return ValueType(frozenset((MAP, NULL)), ({"properties": {"name": {"type": "string"}, "data": {}}},))
        possible = [name for name in events if known.events is None or name in known.events]
        name = {"type": "string"}
        data = [events[n] if isinstance(events[n], Mapping) else {} for n in possible]
        return ValueType(frozenset((MAP,)), tuple({"properties": {"name": name, "data": d}} for d in data))

    def member(self, node: FieldAccess | IndexAccess, known: KnownFacts, *, must_exist: bool = True) -> ValueType:
        base = self.type(node.base, known)
        match node:
            case FieldAccess(name=key) | IndexAccess(key=Literal(value=str() as key)):
                pass
            case IndexAccess(key=index):
                return self.index(node, base, self.type(index, known))
        if not self.expect(node.base, base, frozenset((MAP,)), f"to have `{key}`"):
            return ANY
        found, presence = base.field(key)
        path = path_of(node)
        if must_exist or path in (None, ("context", key)):
            self.presence(node, key, base, presence, path in known.present)
        return found

    def index(self, node: IndexAccess, base: ValueType, index: ValueType) -> ValueType:
        indexed = {LIST: NUMBER, MAP: TEXT}
        if self.expect(node.base, base, frozenset(indexed), "before `[`"):
            wanted = frozenset(indexed[kind] for kind in base.kinds if kind in indexed)
            self.expect(node.key, index, wanted, "as an index")
        return base.element() if base.kinds == {LIST} else ANY

    def presence(
        self, node: FieldAccess | IndexAccess, key: str, base: ValueType, presence: FieldPresence, guarded: bool
    ) -> None:
        """Report a field that does not exist, or that may be missing."""
        start = node.end - len(key) if isinstance(node, FieldAccess) else node.key.offset
        path = path_of(node) or ()
        owner = ".".join(path[:-1]) or "this"
        if path[:1] == ("context",) and len(path) == 2 and presence is FieldPresence.UNDECLARED:
            hint = did_you_mean(key, base.fields(), "`context` has")
            self.report(UNKNOWN_CONTEXT_KEY, node, f"the context has no `{key}`", hint, start)
        elif guarded or presence is FieldPresence.SURE:
            return
        elif presence is FieldPresence.UNDECLARED:
            hint = did_you_mean(key, base.fields(), f"`{owner}` has")
            several = base.fields() and key in base.fields()
            message = f"not every event here has `{owner}.{key}`" if several else f"`{owner}` has no `{key}`"
            hint = f"check it with `has({owner}.{key})` first" if several else hint
            if path == ("event", key) and key not in ("data", "name"):
                hint = f"the event's fields are in its data: `event.data.{key}`"
            self.report(UNKNOWN_FIELD, node, message, hint, start)
        else:
            hint = f"check it with `has({owner}.{key})` first"
            self.report(UNGUARDED_FIELD, node, f"`{owner}.{key}` may be missing", hint, start)

    def binary(self, node: Binary, left: ValueType, right: ValueType) -> ValueType:
        match node.sign:
            case "==" | "!=":
                asks_null = any(isinstance(n, Literal) and n.value is None for n in (node.left, node.right))
                if not left.kinds & right.kinds and not asks_null:
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
                    self.mismatch(node, left, right, "`+` adds two numbers, or joins two texts or two lists")
                return ValueType(common or KINDS)
        for operand, found in ((node.left, left), (node.right, right)):
            self.expect(operand, found, frozenset((NUMBER,)), f"by `{node.sign}`")
        return of(NUMBER)

    def mismatch(self, node: Binary, left: ValueType, right: ValueType, hint: str) -> None:
        message = f"{in_words(left.kinds)} and {in_words(right.kinds)} can't be combined in `{node.sign}`"
        self.report(TYPE_MISMATCH, node, message, hint)

    def call(self, node: FunctionCall, known: KnownFacts) -> ValueType:
        function = function_of(node, self.around, self.findings)
        if function is None:
            for argument in node.arguments:
                self.type(argument, known)
            return ANY
        if node.function == "has" and len(node.arguments) == 1:
            return self.has(node, known)
        check_purity(node, self.around, self.findings)
        if isinstance(function, OwnFunction):
            self.arguments(node, function, known)
            return ValueType(function.returns)
        for argument, kinds in zip(node.arguments, function.parameters, strict=False):
            self.expect(argument, self.type(argument, known), kinds, f"by `{node.function}`")
        check_names(node, self.around, self.findings)
        return ValueType(function.returns)

    def arguments(self, node: FunctionCall, function: OwnFunction, known: KnownFacts) -> None:
        """Check the arguments of a function of the project, whose parameters have names."""
        for argument, (name, kinds) in zip(node.arguments, function.parameters.items(), strict=False):
            found = self.type(argument, known).kinds
            if not found & kinds:
                what = f"`{unparse(argument)}` is {in_words(found)}"
                message = f"{what}, but `{name}` of `{node.function}` must be {in_words(kinds)}"
                self.report(TYPE_MISMATCH, argument, message)

    def has(self, node: FunctionCall, known: KnownFacts) -> ValueType:
        target = node.arguments[0]
        if isinstance(target, FieldAccess | IndexAccess):
            self.member(target, known & KnownFacts(prefixes(target)), must_exist=False)
        else:
            self.report(
                WRONG_ARGUMENT,
                target,
                "the argument of `has` must be a field",
                "write, for example, `has(event.data.x)`",
            )
        return of(BOOLEAN)
