"""Fuzzy Control Language as jFuzzyLogic means it: its shapes and their universe, its formulas, its pairs of operators.

The expected numbers were computed by hand from jFuzzyLogic's formulas, given beside each number.
"""

import math
from typing import Any

import pytest

from lumen.features.formats_fuzzy.fcl import read_fcl
from lumen.fuzzy import Controller
from tests.tables import for_each


def said(text: str) -> tuple[dict[str, Any], list[str]]:
    data, found = read_fcl("file", text.encode(), "file")
    return data, [f"{d.place.line}:{d.place.column} {d.message}" for d in found]


def a_block(tip: str, rules: str = "") -> str:
    return (
        f"FUNCTION_BLOCK f VAR_INPUT s : REAL; {'t : REAL;' if 'LN(t)' in tip else ''} END_VAR\n"
        "FUZZIFY s TERM low := (0, 1) (4, 0); TERM high := (0, 0) (4, 1); RANGE := (0 .. 4); END_FUZZIFY\n"
        f"DEFUZZIFY tip {tip} END_DEFUZZIFY RULEBLOCK r {rules}\n"
        "RULE 1 : IF s IS low THEN tip IS a; RULE 2 : IF s IS high THEN tip IS b;\n"
        "RULE 3 : IF s IS high THEN tip IS b;\n"
        "END_RULEBLOCK END_FUNCTION_BLOCK"
    )


def test_what_jfuzzylogic_computes_from_its_inputs() -> None:
    """A FUNCTION term may use an input that no rule uses, and ACCU combines the degrees of one term."""
    tip = "TERM a := FUNCTION 2 * s + LN(t) ^ 2 - Log(100); TERM b := 7; METHOD : COGF;"
    data, found = said(a_block(tip, "ACCU : MAX;"))
    assert found == ["3:1 the range of `tip` is empty, so its values are not limited"]
    a = 2 * 1 + 1.0 - 2
    assert Controller.from_dict(data).evaluate({"s": 1, "t": 2.718281828459045})["tip"] == pytest.approx(
        (0.75 * a + 0.25 * 7) / 1.0
    )
    summed = Controller.from_dict(said(a_block(tip))[0]).evaluate({"s": 1, "t": 1})["tip"]
    assert summed == pytest.approx((0.75 * 0 + 0.5 * 7) / 1.25)


@for_each("formula", ["2 ^ s ^ 2", "-2 ^ s", "s % 2 * 3", "x + 1", "thing", "(s"])
def test_a_function_that_means_another_thing_here_is_left_out(formula: str) -> None:
    _, found = said(a_block(f"TERM a := FUNCTION {formula}; TERM b := 7; METHOD : COGS;"))
    assert any("the term `a` of `tip` is left out" in line for line in found)


@for_each(
    ("term", "ends", "height"),
    [  # (a term, how far jFuzzyLogic's `estimateUniverse` goes, its membership at 6)
        ("GAUSS 5 2", [-3, 13], 0.8824969025845955),
        ("GAUSS2 4 1 5 2", [0, 13], 0.8824969025845955),
        ("GBELL 2 1 5", [5 - 2 * 999**0.5, 5 + 2 * 999**0.5], 0.8),
        ("SIGM 3 5", [2, 8], 0.9525741268224334),
        ("DSIGM 3 5 3 8", [2, 11], 0.9525741268224334 - 0.0024726231566347743),
        ("DSIGM 3 5 2 8", [2, 12.5], 0.9525741268224334 - 0.01798620996209156),
        ("COSINE 4 5", [1, 9], 0.8535533905932737),
        ("TRIAN 1 5 9", [1, 9], 0.75),
        ("TRAPE 1 2 5 9", [1, 9], 0.75),
    ],
)
def test_the_shapes_and_the_universe_of_jfuzzylogic(term: str, ends: list[float], height: float) -> None:
    data, _ = said(f"FUZZIFY s TERM h := {term}; END_FUZZIFY " + a_block("TERM a := 0; TERM b := 1;"))
    [variable] = [spec for spec in data["inputs"].values() if "h" in spec["terms"]]
    if "function" not in variable["terms"]["h"]:
        assert variable["range"] == pytest.approx(ends)
    one = {
        "inputs": {"s": variable},
        "outputs": data["outputs"],
        "rules": ["if s is h then tip is b", "if s is not h then tip is a"],
    }
    assert Controller.from_dict(one).evaluate({"s": 6})["tip"] == pytest.approx(height)


def test_a_gaussian_without_range_as_jfuzzylogic_has_it() -> None:
    """Its 1,000 steps from the left end of each; 3 sigma instead of 4 were 1 to 4 % off."""
    tip = "TERM a := GAUSS 5 2; TERM b := GAUSS 20 5; METHOD : COG;"
    controller = Controller.from_dict(said(a_block(tip, "ACCU : MAX;"))[0])
    low, high = -3.0, 40.0
    for s in (0.5, 1.0, 2.0, 3.0, 3.5):
        points = [low + i * (high - low) / 1000 for i in range(1000)]
        degrees = [
            max(min(1 - s / 4, math.exp(-((x - 5) ** 2) / 8)), min(s / 4, math.exp(-((x - 20) ** 2) / 50)))
            for x in points
        ]
        theirs = sum(x * y for x, y in zip(points, degrees, strict=True)) / sum(degrees)
        assert controller.evaluate({"s": s})["tip"] == pytest.approx(theirs, abs=(high - low) / 1000)


@for_each(
    ("block", "operators"),
    [
        ("AND : PROD;", ("algebraic-product", "algebraic-sum")),
        ("OR : DMAX;", ("drastic-product", "drastic-sum")),
        ("AND : HAMACHER;", ("hamacher-product", "einstein-sum")),
        ("OR : EINSTEIN;", ("hamacher-product", "einstein-sum")),
        ("AND : EPROD; OR : ESUM;", ("einstein-product", "einstein-sum")),
        ("AND : NIPMIN; OR : NIPMAX;", ("nilpotent-minimum", "nilpotent-maximum")),
    ],
)
def test_the_operators_of_fcl(block: str, operators: tuple[str, str]) -> None:
    data, found = said(a_block("TERM a := 0; TERM b := 1; RANGE := (0 .. 9);", block))
    assert found == []
    assert (data["operators"]["conjunction"], data["operators"]["disjunction"]) == operators
