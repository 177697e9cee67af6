"""Messages about unreadable expressions and expressions without a value, and their places."""

import pytest

from lumen.expressions import ExpressionError, Scope, compile_expression, compile_guard
from tests.expressions.scopes import SCOPE
from tests.tables import for_each

# source: offset, message, part of the hint
UNREADABLE: dict[str, tuple[int, str, str]] = {
    "": (0, "there is no expression", ""),
    "1 +": (3, "the expression ends too early", ""),
    "(1": (2, "the expression ends too early", "a `)` is missing"),
    "[1 2]": (3, "`2` is not allowed here", "a `]` is missing"),
    "1 1": (2, "`1` is not allowed here", ""),
    "context.": (8, "the expression ends too early", "write a name after"),
    "context.n = 2": (10, "`=` has no meaning here", "compare with `==`"),
    "context.n & true": (10, "`&` has no meaning here", "`&&`"),
    "context.n and true": (10, "`and` is not allowed here", "write `&&`"),
    "not true": (0, "`not` is not allowed here", "write `!`"),
    "True": (0, "`True` is not allowed here", "write `true`"),
    "in": (0, "`in` is not allowed here", ""),
    "true ? 1": (8, "the expression ends too early", "a `:` is missing"),
    "'abc": (0, "this text is not closed", "close the text"),
    "“abc”": (0, "`“` has no meaning here", "straight quotes"),
    r"'\d'": (1, r"`\d` is not an escape", "r'…'"),
    r"'\ud800'": (1, r"`\ud800` is not an escape", ""),
    "12u": (2, "`u` can't follow a number", "without `u`"),
    "9223372036854775808": (0, "`9223372036854775808` is too large", "64 bits"),
    "1e999": (0, "the number `1e999` is too large", ""),
    "{a: 1}": (1, "`a` is not allowed here", "put the key in quotes: 'a'"),
    "{'a': 1, 'a': 2}": (9, "the key 'a' is in the map twice", ""),
    "visitor == 1": (0, "there is no name `visitor`", "`context`"),
    "contxt.n": (0, "there is no name `contxt`", "did you mean `context`?"),
    "hour == 1": (0, "there is no name `hour`", "write `hour(…)`"),
    "sze('a')": (0, "there is no function `sze`", "did you mean `size`?"),
    "context.name.startsWith('A')": (13, "there is no function `startsWith`", "did you mean `matches`?"),
    "1 + size()": (4, "`size` takes 1 argument, and none are given", "write `size(text)`"),
    "hour(1)": (0, "`hour` takes no arguments, and 1 is given", "write `hour()`"),
    "'a'.contains()": (4, "`contains` takes 2 arguments, and 1 is given", ""),
    "has(1)": (4, "the argument of `has` must be a field", "has(event.data.x)"),
    "has(context)": (4, "the argument of `has` must be a field", ""),
    "matches('a', context.name)": (13, "the pattern of `matches` must be a text in quotes", ""),
    "matches('a', '(?!a)')": (13, "in the pattern, this kind of `(?` group is not allowed", ""),
    "false && nothing()": (9, "there is no function `nothing`", ""),
}
WORTHLESS: dict[str, tuple[int, str, str]] = {
    "context.m": (8, "`context` has no `m`", ""),
    "context.nam": (8, "`context` has no `nam`", "did you mean `name`?"),
    "1 + context.map.q": (16, "`context.map` has no `q`", "`context.map` has `a`"),
    "context['nam']": (8, "`context` has no `nam`", "did you mean `name`?"),
    "context.n.x": (10, "`context.n` is a number, so it has no `x`", ""),
    "context.name['x']": (13, "`context.name` is a text, so it has no `x`", ""),
    "context.list.x": (13, "`context.list` is a list, so it has no `x`", ""),
    "lookup('x', 'faq').y": (19, "`lookup('x', 'faq')` is not a map, so it has no `y`", ""),
    "context.list[3]": (0, "there is no element 3 in a list of length 3", "count from 0"),
    "context.list[-1]": (0, "there is no element -1 in a list of length 3", ""),
    "context.list[0.5]": (0, "there is no element 0.5 in a list of length 3", ""),
    "context.list[true]": (13, "`true` is true or false, but `[…]` needs a number", ""),
    "context.map[context.n]": (12, "`context.n` is a number, but `[…]` needs a text", ""),
    "context.n[0]": (0, "`context.n` is a number, but `[…]` needs a list or a map", ""),
    "1 < 'a'": (0, "a number and a text can't be combined in `<`", ""),
    "context.yes < 2": (0, "true or false and a number can't be combined in `<`", ""),
    "[1] < [2]": (0, "a list and a list can't be combined in `<`", ""),
    "true && context.none >= 1": (8, "null and a number can't be combined in `>=`", ""),
    "1 + 'a'": (0, "a number and a text can't be combined in `+`", ""),
    "context.name - 1": (0, "`context.name` is a text, but `-` needs a number", ""),
    "1 * context.name": (4, "`context.name` is a text, but `*` needs a number", ""),
    "true + 1": (0, "true or false and a number can't be combined in `+`", ""),
    "-context.name": (1, "`context.name` is a text, but `-` needs a number", ""),
    "!context.n": (1, "`context.n` is a number, but `!` needs true or false", ""),
    "true && context.n": (8, "`context.n` is a number, but true or false is needed", ""),
    "context.n || false": (0, "`context.n` is a number, but true or false is needed", ""),
    "context.n ? 1 : 2": (0, "`context.n` is a number, but true or false is needed", ""),
    "1 / 0": (0, "this divides by zero", ""),
    "1.5 / 0.0": (0, "this divides by zero", ""),
    "1 % 0": (0, "this divides by zero", ""),
    "context.big + 1": (0, "the number becomes too large", "64 bits"),
    "context.big * context.big": (0, "the number becomes too large", ""),
    "-9223372036854775808 / -1": (0, "the number becomes too large", ""),
    "1e308 * 10": (0, "the number becomes too large", ""),
    "1 in 'a'": (5, "`'a'` is a text, but `in` needs a list or a map", ""),
    "size(1)": (5, "`1` is a number, but `size` needs a text or a list or a map", ""),
    "contains('a', context.n)": (14, "`context.n` is a number, but `contains` needs a text", ""),
    "lower(context.none)": (6, "`context.none` is null, but `lower` needs a text", ""),
    "heard('a', 'danse')": (0, "there are no phrases named `danse`", "did you mean `dance`?"),
    "heard('a', context.list)": (0, "these are not phrases", "a list of texts, or one for each language"),
    "heard('b', context.map)": (0, "these are not phrases", "a list of texts, or one for each language"),
    "heard('a', {'en': context.n})": (0, "these are not phrases", "a list of texts, or one for each language"),
    "lookup('a', 'fqa')": (0, "there are no answers named `fqa`", "did you mean `faq`?"),
}


@for_each("source", UNREADABLE)
def test_unreadable(source: str) -> None:
    with pytest.raises(ExpressionError) as raised:
        compile_expression(source)
    expect(raised.value, UNREADABLE[source])


@for_each("source", WORTHLESS)
def test_worthless(source: str) -> None:
    evaluate = compile_expression(source)
    with pytest.raises(ExpressionError) as raised:
        evaluate(SCOPE)
    expect(raised.value, WORTHLESS[source])


def expect(error: ExpressionError, expected: tuple[int, str, str]) -> None:
    assert (error.offset, error.message) == expected[:2]
    assert expected[2] in error.hint
    assert "\n" not in str(error)


def test_no_event() -> None:
    with pytest.raises(ExpressionError, match="there is no event here"):
        compile_expression("event.data.x")(Scope())


def test_a_guard_is_true_or_false() -> None:
    with pytest.raises(ExpressionError, match=r"`context\.n` is a number, but true or false is needed"):
        compile_guard("context.n")(SCOPE)


def test_what_is_not_json_is_refused() -> None:
    with pytest.raises(ExpressionError, match="an expression can't use this value"):
        compile_expression("context.x == context.x")(Scope(context={"x": object()}))
