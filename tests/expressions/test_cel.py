"""The language against Google's CEL: the same values and the same faults, but for the table in docs/expressions.md."""

import re
from collections import Counter

import pytest
from hypothesis import HealthCheck, given, seed, settings
from hypothesis import strategies as st

from lumen.expressions import ExpressionNode, Scope
from tests import ROOT
from tests.expressions.cel import Outcome, by_cel, by_lumen, compare, same
from tests.expressions.typed import expressions, scopes
from tests.tables import for_each

BUSY = settings(deadline=None, database=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])
DOCS = ROOT / "docs/expressions.md"
SCOPE = Scope(context={"n": 1, "m": {"y": 1}, "l": [1]}, event={"name": "e", "data": {}}, state={"path": "p"})
ERROR = ("error",)

DIFFERENT: dict[str, list[tuple[str, object, object]]] = {
    "`1 + 1.5` is 2.5": [("1 + 1.5", 2.5, ERROR), ("3 * 0.5", 1.5, ERROR), ("1 / 2.0", 0.5, ERROR)],
    "`7.5 % 2` is 1.5": [("7.5 % 2", 1.5, ERROR), ("7.5 % 2.0", 1.5, ERROR)],
    "`1.0 / 0.0` and `1e308 * 10` are errors": [
        ("1.0 / 0.0", ERROR, float("inf")),
        ("1e308 * 10.0", ERROR, float("inf")),
    ],
    "`9007199254740993 == 9007199254740992.0` is false": [
        ("9007199254740993 == 9007199254740992.0", False, True),
        ("9223372036854775807 < 9223372036854775808.0", True, False),
    ],
    "`null in {'a': 1}` is false": [("null in {'a': 1}", False, ERROR), ("[1] in {'a': 1}", False, ERROR)],
    "`!!1`, `--'a'` are errors": [("!!1", ERROR, 1), ("--'a'", ERROR, "a")],
    "`a ? b ? 1 : 2 : 3` is accepted": [("true ? false ? 1 : 2 : 3", 2, ERROR)],
    "no `1u`, bytes, timestamps, durations, types": [
        ("1u + 2u == 3u", ERROR, True),
        ("size(b'abc')", ERROR, 3),
        ("duration('1m') > duration('1s')", ERROR, True),
        ("timestamp('2015-01-01T00:00:00Z').getFullYear()", ERROR, 2015),
        ("type(1) == int", ERROR, True),
    ],
    "`has(event.data.a.b)` is false without `a`; also `has(x['y'])`, `has(x[0])`": [
        ("has(event.data.a.b)", False, ERROR),
        ("has(context.n.b)", False, ERROR),
        ("has(context.m['y'])", True, ERROR),
        ("has(context.l[0])", True, ERROR),
    ],
    "`null < 1`, `[1] < [2]` are errors at run time, and found by lint": [
        ("null < 1", ERROR, ERROR),
        ("[1] < [2]", ERROR, ERROR),
    ],
    "keys of a map are quoted texts, each once": [("{1: 2}[1]", ERROR, 2), ("{'a' + 'b': 1}.ab", ERROR, 1)],
    "`matches` takes a literal; its `\\w`, `\\d`, `\\b` include every script": [
        ("'a'.matches('' + 'a')", ERROR, True),
        (r"'é'.matches(r'^\w$')", True, False),
        (r"'٣'.matches(r'^\d$')", True, False),
        (r"'élan'.matches(r'\blan')", False, True),
    ],
    "`trim`, `lower`, `replace` for every script, of at most 1,000 characters": [("'É'.lower()", "é", ERROR)],
    "no `startsWith`, `endsWith`, `int()`, `string()`, macros such as `all` and `map`, comments": [
        ("'ab'.startsWith('a')", ERROR, True),
        ("'ab'.endsWith('b')", ERROR, True),
        ("int('1')", ERROR, 1),
        ("string(1)", ERROR, "1"),
        ("[1, 2].all(x, x > 0)", ERROR, True),
        ("[1, 2].map(x, x + 1)", ERROR, [2, 3]),
        ("1 // one", ERROR, 1),
    ],
    "`after`, `words`, `heard`, `lookup`, `In`, `now`, `hour`, `minute`, `date`, `weekday`": [
        ("after('my name is Ada', 'name is')", "Ada", ERROR),
        ("words('Hi, you')", ["Hi", "you"], ERROR),
        ("now()", "00:00", ERROR),
        ("hour() + minute()", 0, ERROR),
        ("date() + weekday()", "1970-01-01thu", ERROR),
        ("In('a')", False, ERROR),
    ],
}
"""By the first column of each table row: expressions with their outcomes here and in CEL."""


@for_each("row", DIFFERENT)
def test_a_difference_is_as_the_table_says(row: str) -> None:
    for source, ours, theirs in DIFFERENT[row]:
        assert same(by_lumen(source, SCOPE), outcome(ours)), source
        assert same(readable(source), outcome(theirs)), source


def outcome(value: object) -> Outcome:
    return ERROR if value is ERROR else ("value", value)


def readable(source: str) -> Outcome:
    """Return the outcome in CEL; an error if CEL can't read the expression."""
    try:
        return by_cel(source, SCOPE)
    except RuntimeError:
        return ERROR


def test_the_table_has_these_rows() -> None:
    table = DOCS.read_text(encoding="utf-8").partition("## Differences from CEL")[2]
    assert re.findall(r"^\| (.*?) \|", table, re.MULTILINE)[2:] == list(DIFFERENT)


@pytest.mark.slow
@seed(2015)
@settings(BUSY, max_examples=150)
@given(expressions(), scopes)
def test_a_hundred_and_fifty_expressions(tree: ExpressionNode, scope: Scope) -> None:
    compare(tree, scope)


PREFIXES = st.sampled_from(["", "", "", "-", "!", "-(", "!("])
OPERANDS = st.sampled_from(
    ["0", "1", "2", "-3", "true", "false", "null", "'a'", "[1]", "context.n", "[1][0]", "size('ab')"]
)
OPERATORS = st.sampled_from(["+", "-", "*", "/", "%", "==", "!=", "<", "<=", ">", ">=", "in", "&&", "||"])


@st.composite
def flat(draw: st.DrawFn) -> str:
    """Operands and operators in a row, with few brackets, so that precedence decides their grouping."""
    parts = []
    for _ in range(draw(st.integers(1, 6))):
        prefix = draw(PREFIXES)
        parts += [prefix + draw(OPERANDS) + ")" * prefix.count("("), draw(OPERATORS)]
    row = " ".join(parts[:-1])
    return f"{row} ? {draw(OPERANDS)} : {draw(flat())}" if draw(st.integers(0, 5)) == 5 else row


@pytest.mark.slow
@seed(2015)
@settings(BUSY, max_examples=500)
@given(flat())
def test_operators_bind_alike(source: str) -> None:
    assert same(by_lumen(source, SCOPE), readable(source))


@pytest.mark.soak
def test_twenty_thousand_expressions() -> None:
    tally = Counter[str]()
    for thousand in range(20):

        @seed(thousand)
        @settings(BUSY, max_examples=1_000)
        @given(expressions(), scopes, flat())
        def everything(tree: ExpressionNode, scope: Scope, row: str) -> None:
            tally["expressions"] += 1
            tally["the same" if compare(tree, scope) else "different on purpose"] += 1
            assert same(by_lumen(row, SCOPE), readable(row))

        everything()
    print("\n", ", ".join(f"{count:,} {what}" for what, count in tally.items()))  # noqa: T201
    assert tally["expressions"] >= 20_000
