"""Expressions cannot reach Python, and no value from an author or a message grows large or runs long."""

import gc
import sys
from typing import Any

import pytest

from lumen.expressions import (
    ExpressionError,
    Scope,
    check_expression,
    compile_expression,
    compile_template,
)
from tests.expressions.scopes import SCOPE
from tests.tables import for_each


@for_each(
    "source",
    [
        "context.__class__",
        "context.items",
        "context.name.__class__",
        "context.list.append",
        "'a'.__class__",
        "(1).real",
        "state.configuration",
        "event.data.__dict__",
        "context['__class__']",
        "context.name['__len__']",
        "scope",
        "scope.context",
        "evaluate",
        "failed",
        "v0",
        "__builtins__",
        "__import__('os')",
        "open('x')",
        "eval('1')",
        "type(1)",
        "bounded(1)",
        "call_size('a')",
        "lambda: 1",
        "[x for x in context]",
        "context.map(x, x)",
        "f'{1}'",
        "b'a'",
        "1 if true else 2",
        "2 ** 3",
        "1 << 3",
        "a := 1",
        "{1, 2}",
    ],
)
def test_python_is_out_of_reach(source: str) -> None:
    with pytest.raises(ExpressionError):
        compile_expression(source)(SCOPE)


@for_each("source", ["'a' * 9", "9 * 'a'", "[1] * 9", "'%s' % 'a'", "-'a'", "context.name + 1"])
def test_no_python_operators(source: str) -> None:
    with pytest.raises(ExpressionError):
        compile_expression(source)(SCOPE)


def grown(source: str, value: Any, rounds: int = 70) -> Any:
    """Return the value after assigning the expression to `context.x` again and again."""
    evaluate = compile_expression(source)
    for _ in range(rounds):
        value = evaluate(Scope(context={"x": value}))
    return value


@for_each(
    ("source", "first"),
    [
        ("context.x + context.x", "ab"),
        ("context.x + context.x", [1]),
        ("[context.x, context.x]", 1),
        ("[context.x]", 1),
        ("{'a': context.x, 'b': context.x}", 1),
        ("context.x + [context.x]", []),
        ("[[context.x, context.x]][0]", 1),
        ("[context.x + context.x + 'ab']", "ab"),
        ("context.x * context.x", 3),
        ("context.x * context.x", 3.5),
        ("context.x + context.x", 1),
        ("replace(context.x, 'a', context.x + 'a')", "a"),
        ("true ? [context.x, context.x] : 1", 1),
        ("context.x - 9223372036854775807", 1),
    ],
)
def test_nothing_grows_without_bound(source: str, first: Any) -> None:
    with pytest.raises(ExpressionError):
        grown(source, first)


@for_each(
    "source",
    [
        "(" * 101 + "1" + ")" * 101,
        "[" * 60 + "]" * 60,
        "-" * 60 + "1",
        "!" * 60 + "true",
        "1" + " + 1" * 60,
        "context" + ".a" * 60,
        "{'a': " * 60 + "1" + "}" * 60,
        "true ? " * 60 + "1" + ": 1" * 60,
        "size(" * 60 + "''" + ")" * 60,
        "context" + "[context" * 60 + "]" * 60,
        "(" * 2000,
        "[" * 2000,
        "-" * 1999 + "1",
        "x" * 2001,
        "context" + ".a" * 900,
        "1" + "+1" * 900,
        "context" + "[0]" * 600,
    ],
)
def test_large_and_deep_sources_are_refused(source: str) -> None:
    with pytest.raises(ExpressionError, match=r"levels|characters"):
        compile_expression(source)
    assert check_expression(source, context={})[0].code == "expression-syntax"


@for_each(
    ("source", "value"),
    [
        ("(" * 90 + "1" + ")" * 90, 1),
        ("[" * 48 + "1" + "]" * 48 + " == 1", False),
        ("!" * 48 + "true", True),
        ("1" + "+1" * 48, 49),
        ("true" + " && true" * 240, True),
        ("false" + " || false" * 200 + " || true", True),
        ("(true && " * 48 + "true" + ")" * 48, True),
        ("(" * 40 + "context.q" + " || true)" * 40, True),
        ("false ? 1 : " * 48 + "2", 2),
    ],
)
def test_what_is_allowed_works(source: str, value: Any) -> None:
    assert compile_expression(source)(SCOPE) == value


def test_deep_data_is_an_error_not_a_crash() -> None:
    deep: list[Any] = []
    for _ in range(sys.getrecursionlimit() * 2):
        deep = [deep]
    scope = Scope(context={"a": deep, "b": [*deep]})
    for source in ("context.a == context.b", "[context.a] == context.b", "[context.a]", "context.a in [context.b]"):
        with pytest.raises(ExpressionError, match=r"nested too deeply|too large"):
            compile_expression(source)(scope)
    with pytest.raises(ExpressionError):
        compile_template("{{ context.a }}")(scope)


def test_caches_are_bounded() -> None:
    for n in range(9000):
        compile_template(f"plain {n}")
    assert (compile_template.cache_info().currsize, compile_template.cache_info().maxsize) == (8192, 8192)
    compile_template.cache_clear()
    gc.collect()


def test_errors_stay_small_and_quick() -> None:
    """A message with a hundred thousand keys is not searched for a misspelt one, and an error is one short line."""
    data = {f"key{n}": n for n in range(100_000)} | {"k" * 50_000: 1}
    scope = Scope(context={"text": "t" * 100_000}, event={"name": "a", "data": data}, phrases={"p": {}})
    for source in (
        "event.data.key",
        "heard('a', context.text)",
        "size(\n" + "[1,\n" * 40 + "]" * 40 + ".a)",
        "!('a' +\n 'b')",
    ):
        with pytest.raises(ExpressionError) as raised:
            compile_expression(source)(scope)
        assert len(str(raised.value)) < 400
        assert "\n" not in str(raised.value)
