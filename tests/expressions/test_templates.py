"""Texts with expressions in them."""

import pytest

from lumen.expressions import ExpressionError, Scope, compile_template
from tests.expressions.scopes import SCOPE
from tests.tables import for_each


@for_each(
    ("text", "filled"),
    [
        ("", ""),
        ("Hello!", "Hello!"),
        ("Hello {{ context.name }}!", "Hello Ada!"),
        ("{{context.n}}{{ context.n }}", "22"),
        ("[{{ context.none }}]", "[]"),
        ("{{ context.yes }} {{ !context.yes }}", "true false"),
        ("{{ 1.0 }} {{ 1.5 }} {{ -0.5 }}", "1 1.5 -0.5"),
        ("{{ 1e300 }} {{ 0.1 + 0.2 }} {{ 10 / 4.0 }}", "1e+300 0.30000000000000004 2.5"),
        ("{{ [1.0, 'é', null, {'a': true}] }}", '[1, "é", null, {"a": true}]'),
        ("{{ {'a': {'b': '}}'}}['a']['b'] }}", "}}"),
        ("a }} b", "a }} b"),
        ("{ {{ '{{' }} }", "{ {{ }"),
        ("{{ context.texts }}", '["a", "b"]'),
        ("{{ context.yes ? 'sir' : 'madam' }}, {{ lower('A') }}", "sir, a"),
        ("{{ 9223372036854775807 }}", "9223372036854775807"),
        ("Line\n{{ 'one' }}\n", "Line\none\n"),
        ("{{ {'a': 1}}}", '{"a": 1}'),
        ("%s {0} $x {{ '%s' }}", "%s {0} $x %s"),
    ],
)
def test_filled(text: str, filled: str) -> None:
    assert compile_template(text)(SCOPE) == filled


@for_each(
    ("text", "offset", "message"),
    [
        ("Hi {{ context.name", 3, "this `{{` is not closed"),
        ("Hi {{ }}", 6, "there is no expression"),
        ("Hi {{ 1 + }}", 10, "ends too early"),
        ("Hi {{ 'a }}", 6, "this text is not closed"),
        ("é {{ nam }}", 5, "there is no name `nam`"),
        ("{{ “a” }}", 3, "has no meaning"),
        ("{{ 1 }} {{ 1 2 }}", 13, "`2` is not allowed here"),
    ],
)
def test_unreadable(text: str, offset: int, message: str) -> None:
    with pytest.raises(ExpressionError) as raised:
        compile_template(text)
    assert raised.value.offset == offset
    assert message in raised.value.message


def test_without_a_value() -> None:
    with pytest.raises(ExpressionError, match="`context` has no `nam`") as raised:
        compile_template("Hi {{ context.nam }}")(SCOPE)
    assert raised.value.offset == 14
    assert raised.value.hint.startswith("did you mean `name`?")


@for_each("value", [10**5000, {"a": [0] * 20_000}, "x" * 10_001, object(), ["x" * 200_000]], ids=type)
def test_what_can_not_be_printed(value: object) -> None:
    with pytest.raises(ExpressionError):
        compile_template("{{ context.value }}")(Scope(context={"value": value}))
