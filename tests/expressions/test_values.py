"""The values of expressions."""

from types import MappingProxyType
from typing import Any

from lumen.expressions import Scope, compile_expression, compile_guard
from tests.expressions.scopes import SCOPE
from tests.tables import for_each

VALUES: dict[str, Any] = {
    # literals
    "1": 1, "0x1F": 31, "1.5": 1.5, ".5": 0.5, "2e3": 2000.0, "-3": -3, "- 3": -3, "-9223372036854775808": -(2**63),
    "true": True, "false": False, "null": None, "'a'": "a", '"a"': "a", "'it\\'s'": "it's", r"'\x41\u00e9\n'": "Aé\n",
    r"r'\d'": r"\d", "[]": [], "[1, 'a', [null],]": [1, "a", [None]],
    "{}": {}, "{'a': 1, \"b\": {}}": {"a": 1, "b": {}},
    # paths
    "context.n": 2, "context['n']": 2, "context.map.a.b": 1, "context.map['a']['b']": 1, "event.name": "heard",
    "event.data.ok": True, "state.path": "talk.ask", "context.list[0]": 1, "context.list[1.0]": "a",
    "context.list[context.n][0]": True, "context.visitor['first-name']": "Ada", "{'in': 3}['in']": 3,
    "context.texts[1]": "b", "{'a': [1, 2]}.a[1]": 2,
    # equality: numbers are one kind, different kinds differ
    "1 == 1.0": True, "1 == true": False, "true == 1": False, "0 == false": False, "context.yes == 1": False,
    "'1' == 1": False, "null == null": True, "context.none == null": True, "context.n != null": True,
    "[1, [2]] == [1.0, [2.0]]": True, "[1] == [true]": False, "{'a': 1} == {'a': 1.0}": True, "{'a': 1} == {}": False,
    "[] == {}": False, "context.texts == ['a', 'b']": True, "context.n == 2": True, "context.name == 'Ada'": True,
    "context.yes == true": True, "context.name != true": True, "context.n == 'a'": False, "context.n != 'a'": True,
    "9007199254740993 == 9007199254740992.0": False,
    # order
    "1 < 2": True, "context.n < 3": True, "context.x <= 1.5": True, "context.x > 1": True, "3 >= context.n": True,
    "'a' < 'b'": True, "'Z' < 'a'": True, "false < true": True, "1 < 1.5": True, "(1 < 2) == true": True,
    # logic: CEL's, in which a decisive operand outweighs an error
    "true && false": False, "true || false": True, "!true": False, "!!context.yes": True, "true && true && true": True,
    "false && context.nothing": False, "context.nothing && false": False, "context.nothing || true": True,
    "true || context.n": True, "context.n && false": False, "false || context.nothing == 1 || true": True,
    "!(context.nothing && false)": True, "(context.nothing == 1 || true) && context.n < 3": True,
    "true ? 1 : 1 / 0": 1, "false ? 1 / 0 : 2": 2, "true ? false ? 1 : 2 : 3": 2, "false ? 1 : false ? 2 : 3": 3,
    # arithmetic
    "1 + 2 * 3": 7, "(1 + 2) * 3": 9, "7 / 2": 3, "-7 / 2": -3, "7 / -2": -3, "7.0 / 2": 3.5, "7 % 3": 1, "-7 % 3": -1,
    "7 % -3": 1, "7.5 % 2": 1.5, "1 - 2 - 3": -4, "1 + 1.5": 2.5, "-context.n": -2, "--1": 1, "'a' + 'b'": "ab",
    "[1] + ['a']": [1, "a"], "context.texts + []": ["a", "b"], "1-1": 0, "context.n -1": 1, "2 * -3": -6,
    # in
    "1 in [1, 2]": True, "1.0 in [1]": True, "true in [1]": False, "'n' in context": True, "'q' in context": False,
    "1 in {'1': 2}": False, "[1] in [[1]]": True, "!('a' in [])": True,
    # functions
    "size('añ🤖')": 3, "size([1, 2])": 2, "size({'a': 1})": 1, "'abc'.size()": 3, "size(context.long)": 6000,
    "has(context.n)": True, "has(context.q)": False, "has(event.data.x)": False, "has(event.data.null)": True,
    "has(event.data.ok.deeper)": False, "has(event.nothing.at.all)": False, "has(context.list[2][0])": True,
    "has(context.list[9])": False, "has(context.visitor['first-name'])": True, "has(lookup('x', 'faq').y)": False,
    "lower('ÄB')": "äb", "trim('  a b\\n')": "a b", "contains('abc', 'bc')": True, "'abc'.contains('C')": False,
    "replace('a-b-c', '-', '+')": "a+b+c", "'My name'.lower().replace('my', 'your')": "your name",
    "matches('room 12', r'\\d+$')": True, "'ab'.matches('^b')": False, "hour()": 0,
    "In('talk')": True, "In('dance')": False,
    "words('Hi, my name is Ada-Lou!')": ["Hi", "my", "name", "is", "Ada", "Lou"],
    "heard(event.data.result, 'no')": False, "lookup(event.data.result, 'faq')": "Lumen",
    "after('Well, my name is Ada.', 'my name is')": "Ada",
}  # fmt: skip


@for_each("source", VALUES)
def test_value(source: str) -> None:
    value, expected = compile_expression(source)(SCOPE), VALUES[source]
    assert value == expected
    assert type(value) is type(expected)


def test_roots_are_values() -> None:
    assert compile_expression("context")(SCOPE) == SCOPE.context
    assert compile_expression("event == null")(Scope()) is True


def test_frozen_context() -> None:
    scope = SCOPE._replace(context=MappingProxyType({"a": MappingProxyType({"b": (1, 2)})}))
    assert compile_expression("context.a == {'b': [1, 2]} && size(context.a.b) == 2 && 1 in context.a.b")(scope) is True


def test_equal_sources_are_compiled_once() -> None:
    assert compile_expression("1 + 1") is compile_expression("1 + 1")


def test_a_value_built_is_a_new_one() -> None:
    evaluate = compile_expression("[1, 2]")
    evaluate(SCOPE).append(3)
    assert evaluate(SCOPE) == [1, 2]


def test_guard() -> None:
    assert compile_guard("context.n < 3 && event.data.ok")(SCOPE) is True
    assert compile_guard("event.data.ok")(SCOPE) is True


@for_each(("at", "epoch", "hour"), [(0, 0, 0), (3599.9, 0, 0), (3600, 0, 1), (0, -1, 23), (1e9, 5.5, 1)])
def test_hour(at: float, epoch: float, hour: int) -> None:
    assert compile_expression("hour()")(Scope(at=at, epoch=epoch)) == hour
