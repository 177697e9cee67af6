"""The text of a rule: its meaning, and the word at which it becomes invalid."""

from contextlib import suppress

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lumen.language.controllers import Conjunction, Disjunction, Negation, Proposition
from lumen.project.rule_parser import RuleSyntaxError, parse_rule
from tests.tables import for_each

A, B, C = Proposition("a", "x"), Proposition("b", "y"), Proposition("c", "z")


@for_each(
    ("text", "antecedent"),
    [
        ("a is x", A),
        ("a is x and b is y or c is z", Disjunction(Conjunction(A, B), C)),
        ("a is x or b is y and c is z", Disjunction(A, Conjunction(B, C))),
        ("(a is x or b is y) and c is z", Conjunction(Disjunction(A, B), C)),
        ("a is x and b is y and c is z", Conjunction(Conjunction(A, B), C)),
        ("not a is x", Proposition("a", "x", ("not",))),
        ("not a is very x", Proposition("a", "x", ("not", "very"))),
        ("not (a is x or b is y)", Negation(Disjunction(A, B))),
        ("a is not very x", Proposition("a", "x", ("not", "very"))),
        ("a is any and b is y", Conjunction(Proposition("a", "", ("any",)), B)),
        ("((a is x))", A),
    ],
)
def test_antecedents(text: str, antecedent: object) -> None:
    assert parse_rule(f"if {text} then c is z").antecedent == antecedent


def test_consequents_and_weight() -> None:
    rule = parse_rule("IF a IS x THEN b is y, c is very z AND a is x WITH 0.5")
    assert rule.consequents == (B, Proposition("c", "z", ("very",)), A)
    assert rule.weight == 0.5
    assert [m.variable.text for m in rule.mentions if m.concluded] == ["b", "c", "a"]


@for_each(
    ("text", "offset", "message"),
    [
        ("", 0, "expected `if` here, but the rule ends"),
        ("when a is x then b is y", 0, "expected `if` here, not `when`"),
        ("if a x then b is y", 5, "expected `is` here, not `x`"),
        ("if a is then b is y", 8, "expected a term of `a` here, not `then`"),
        ("if a is x b is y", 10, "expected `then` here, not `b`"),
        ("if a is x the b is y", 10, "expected `then` here, not `the`"),
        ("if a is x then", 14, "expected the name of an output here, but the rule ends"),
        ("if (a is x then b is y", 11, "expected `)` here, not `then`"),
        ("if a is x) then b is y", 9, "expected `then` here, not `)`"),
        ("if a is x and then b is y", 14, "expected the name of an input here, not `then`"),
        ("if a is x then b is y or c is z", 22, "expected the end of the rule, `and` or `with` here, not `or`"),
        ("if a is x then b is y with", 26, "expected the rule's weight here, but the rule ends"),
        ("if a is x then b is y with half", 27, "expected the rule's weight here, not `half`"),
        ("if a is x then b is y with 2", 27, "the weight 2 is not between 0 and 1"),
        ("if a is x then b is y with nan", 27, "the weight nan is not between 0 and 1"),
        ("if a is x then b is y with 0.5 0.5", 31, "expected the end of the rule, `and` or `with` here, not `0.5`"),
        ("if a is x then b is any", 23, "expected a term of `b` here, but the rule ends"),
        ("if " + "(" * 60, 53, "the rule is nested too deeply"),
        ("if " + "(a is x) or " * 20 + "(" * 60, 293, "the rule is nested too deeply"),
    ],
)
def test_where_a_rule_stops_being_one(text: str, offset: int, message: str) -> None:
    with pytest.raises(RuleSyntaxError) as caught:
        parse_rule(text)
    assert (caught.value.message, caught.value.word.offset) == (message, offset)


@given(st.text(alphabet="if then is and or not (),x0.", max_size=60))
def test_no_text_breaks_the_parser(text: str) -> None:
    with suppress(RuleSyntaxError):
        parse_rule(text)
