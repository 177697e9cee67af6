"""Whole controllers: the exact centroid against the sampled set, every method, defaults, state and errors."""

from math import inf
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lumen.errors import LumenError, UsageError
from lumen.fuzzy import Controller
from lumen.fuzzy.defuzzifiers import DEFUZZIFY, Sampled
from lumen.fuzzy.evaluator import infer
from lumen.fuzzy.layers import LayeredCentroid
from lumen.language.controllers import DEFUZZIFIERS, INTEGRAL_DEFUZZIFIERS, S_NORMS, T_NORMS

X = {"range": [0, 10], "terms": {"low": {"ramp": [10, 0]}, "high": {"ramp": [0, 10]}, "mid": {"triangle": [0, 5, 10]}}}
Y = {
    "range": [0, 10],
    "terms": {"small": {"triangle": [0, 2, 4]}, "big": {"gaussian": [8, 1]}, "all": {"rectangle": [0, 10]}},
}


def controller(**changes: Any) -> Controller:
    """Return a controller with inputs `a` and `b`, output `c`, and these changes."""
    output = {**Y, **changes.pop("output", {})}
    rules = changes.pop("rules", ["if a is low then c is small", "if a is high and b is high then c is big"])
    return Controller.from_dict({"inputs": {"a": X, "b": X}, "outputs": {"c": output}, "rules": rules, **changes})


degree = st.one_of(st.just(0.0), st.floats(1e-6, 1))


@settings(deadline=None)
@given(
    st.lists(st.tuples(st.floats(-10, 10), st.floats(0.2, 8)), min_size=1, max_size=4),
    st.data(),
)
def test_the_layered_centroid_is_the_centroid_of_the_sampled_set(
    gaussians: list[tuple[float, float]], data: st.DataObject
) -> None:
    points = [-10 + 20 * (i + 0.5) / 200 for i in range(200)]
    memberships = [[float(np.exp(-0.5 * ((y - c) / s) ** 2)) for y in points] for c, s in gaussians]
    terms = data.draw(st.lists(st.integers(0, len(gaussians) - 1), min_size=1, max_size=6))
    rows = [data.draw(st.lists(degree, min_size=3, max_size=3)) for _ in terms]
    columns = [np.array(row) for row in rows]
    layered = LayeredCentroid(points, memberships, terms)
    dense = Sampled(points, memberships, terms, ["minimum"] * len(terms), "maximum", "centroid")
    expected = dense.crisp_batch(columns)
    assert layered.crisp_batch(columns) == pytest.approx(expected, abs=1e-7, nan_ok=True)
    for i in range(3):
        assert layered.crisp([row[i] for row in rows]) == pytest.approx(expected[i], abs=1e-7, nan_ok=True)


@pytest.mark.slow
@settings(deadline=None, max_examples=60)
@given(
    st.sampled_from(T_NORMS),
    st.sampled_from(S_NORMS),
    st.sampled_from(T_NORMS),
    st.sampled_from(S_NORMS),
    st.sampled_from(INTEGRAL_DEFUZZIFIERS),
    st.sampled_from(["general", "first", "last", "highest", "lowest", "proportional"]),
    st.lists(st.tuples(st.floats(0, 10), st.floats(0, 10)), min_size=1, max_size=5),
)
def test_outputs_stay_in_range_and_a_batch_agrees(
    t: str, s: str, implication: str, aggregation: str, how: str, method: str, points: list[tuple[float, float]]
) -> None:
    rules = [
        "if a is low or b is mid then c is small",
        "if a is high and (b is not very high or a is mid) then c is big with 0.7",
        "if not (a is somewhat low and b is low) then c is very all",
    ]
    operators = {
        "conjunction": t, "disjunction": s, "implication": implication, "aggregation": aggregation,
        "defuzzifier": how, "resolution": 50, "activation": {"method": method, "rules": 2},
    }  # fmt: skip
    c = controller(rules=rules, operators=operators, output={"default": 5})
    single = [c.evaluate({"a": a, "b": b})["c"] for a, b in points]
    assert all(0 <= value <= 10 for value in single)
    batch = c.evaluate_batch({"a": [a for a, _ in points], "b": [b for _, b in points]})["c"]
    if how in ("centroid", "bisector"):
        assert batch == pytest.approx(single, abs=1e-6)


def test_every_integral_defuzzifier_on_a_trapezoid() -> None:
    """A triangle 0-2-4 clipped at one half: flat from 1 to 3, on a range of 0 to 10."""
    for how, value in {"centroid": 2, "bisector": 2, "mean-of-maximum": 2}.items():
        c = controller(rules=["if a is low then c is small"], output={"defuzzifier": how})
        assert c.evaluate({"a": 5, "b": 0})["c"] == pytest.approx(value, abs=0.011)
    for how, value in {"smallest-of-maximum": 1, "largest-of-maximum": 3}.items():
        c = controller(rules=["if a is low then c is small"], output={"defuzzifier": how})
        assert c.evaluate({"a": 5, "b": 0})["c"] == pytest.approx(value, abs=0.011)
    assert set(DEFUZZIFY) == set(INTEGRAL_DEFUZZIFIERS) == set(DEFUZZIFIERS) - {"weighted-average", "weighted-sum"}


def test_takagi_sugeno() -> None:
    output = {"defuzzifier": "weighted-average", "terms": {"flat": {"constant": 2}, "steep": {"linear": [1, 2, 3]}}}
    c = controller(rules=["if a is low then c is flat", "if a is high then c is steep"], output=output)
    assert c.evaluate({"a": 2.5, "b": 1.0})["c"] == pytest.approx(0.75 * 2 + 0.25 * (2.5 + 2.0 + 3.0))
    assert c.evaluate_batch({"a": [2.5], "b": [1.0]})["c"] == pytest.approx([3.375])


def test_weighted_sum_adds_up_equal_terms() -> None:
    output = {"defuzzifier": "weighted-sum", "terms": {"flat": {"constant": 2}}}
    c = controller(rules=["if a is low then c is flat", "if b is low then c is flat"], output=output)
    assert c.evaluate({"a": 5, "b": 0})["c"] == pytest.approx(1.5 * 2)


def test_tsukamoto() -> None:
    output = {"defuzzifier": "weighted-average", "terms": {"up": {"ramp": [0, 10]}, "down": {"ramp": [10, 0]}}}
    c = controller(rules=["if a is high then c is up", "if a is low then c is down"], output=output)
    assert c.evaluate({"a": 7, "b": 0})["c"] == pytest.approx((0.7 * 7 + 0.3 * 7) / 1.0)


def test_a_rule_may_ask_what_was_concluded_before() -> None:
    data = {
        "inputs": {"a": X},
        "outputs": {"c": Y, "d": {"range": [0, 1], "terms": {"yes": {"ramp": [0, 1]}, "no": {"ramp": [1, 0]}}}},
        "rules": ["if a is low then c is small"],
        "blocks": {"then": {"rules": ["if c is small then d is yes", "if c is not small then d is no"]}},
    }
    said = Controller.from_dict(data).explain({"a": 3.0})
    assert [degree for _, degree in said.rules] == pytest.approx([0.7, 0.7, 0.3])


def test_any_needs_no_term() -> None:
    c = controller(rules=["if a is any then c is small"])
    assert c.evaluate({"a": 99, "b": 0})["c"] == pytest.approx(2, abs=1e-9)
    assert c.evaluate_batch({"a": [99, 1], "b": [0, 0]})["c"] == pytest.approx([2, 2])


def test_a_hedged_consequent_of_a_rule_that_takes_no_part_concludes_nothing() -> None:
    first = {"activation": {"method": "first", "rules": 1}}
    c = controller(rules=["if a is low then c is small", "if a is high then c is not big"], operators=first)
    assert c.evaluate({"a": 0, "b": 0})["c"] == pytest.approx(2, abs=1e-6)


def test_lock_range_keeps_inputs_and_outputs_in() -> None:
    locked = {**X, "lock-range": True}
    output = {**Y, "lock-range": True, "defuzzifier": "weighted-sum", "terms": {"far": {"constant": 99}}}
    data = {"inputs": {"a": locked}, "outputs": {"c": output}, "rules": ["if a is mid or a is high then c is far"]}
    c = Controller.from_dict(data)
    assert c.evaluate({"a": 1000})["c"] == 10
    assert c.evaluate_batch({"a": [1000, 3]})["c"] == pytest.approx([10, 10])


def test_lock_previous_takes_the_value_handed_in() -> None:
    c = controller(rules=["if a is mid then c is small"], output={"lock-previous": True, "default": 7})
    assert c.evaluate({"a": 0, "b": 0})["c"] == 7
    assert c.evaluate({"a": 0, "b": 0}, {"c": 3.5})["c"] == 3.5
    batch = c.evaluate_batch({"a": [0, 5, 0, 11], "b": [0] * 4}, {"c": 3.5})["c"]
    assert batch == pytest.approx([3.5, 2, 2, 2])


def test_without_a_default_silence_is_an_error() -> None:
    c = controller(rules=["if a is mid then c is small"])
    with pytest.raises(LumenError, match="no rule for `c` fires at a = 0, b = 1: add a `default` to the output"):
        c.evaluate({"a": 0, "b": 1})
    with pytest.raises(LumenError, match="no rule for `c` fires at a = 11, b = 1"):
        c.evaluate_batch({"a": [5, 11], "b": [1, 1]})
    with pytest.raises(LumenError):
        c.explain({"a": 0, "b": 1})


def test_an_output_that_no_rule_concludes_has_its_default() -> None:
    data = {"inputs": {"a": X}, "outputs": {"c": Y, "d": {**Y, "default": 4}}, "rules": ["if a is any then c is small"]}
    c = Controller.from_dict(data)
    assert c.evaluate({"a": 1})["d"] == 4
    assert c.evaluate_batch({"a": [1, 2]})["d"] == pytest.approx([4, 4])
    assert c.explain({"a": 1}).outputs["d"].fired is False


def test_a_sum_without_bound_is_the_same_in_a_batch() -> None:
    """A term clipped at 2 is the whole term: flat from 0 to 4, then falling to 8."""
    c = controller(
        rules=["if a is any or b is any then c is shelf"],
        operators={"disjunction": "unbounded-sum"},
        output={"terms": {"shelf": {"trapezoid": [0, 0, 4, 8]}}},
    )
    assert c.evaluate({"a": 1, "b": 1})["c"] == pytest.approx(28 / 9, abs=1e-4)
    assert c.evaluate_batch({"a": [1.0], "b": [1.0]})["c"] == pytest.approx([28 / 9], abs=1e-4)


@pytest.mark.parametrize("shape", [{"sigmoid": [5, 0]}, {"bell": [5, 2, 0]}])
def test_what_has_no_slope_is_one_half_at_infinity_too(shape: dict[str, Any]) -> None:
    flat = {"range": [0, 10], "terms": {"even": shape}}
    rules = ["if a is even then c is small"]
    c = Controller.from_dict({"inputs": {"a": flat}, "outputs": {"c": Y}, "rules": rules})
    assert c.evaluate({"a": inf})["c"] == pytest.approx(2)
    assert c.evaluate_batch({"a": [inf, -inf, 5.0]})["c"] == pytest.approx([2, 2, 2])


@pytest.mark.parametrize("odd", [10**400, "far", None, [1.0, [2.0]]])
def test_an_input_that_is_no_number_is_told(odd: Any) -> None:
    with pytest.raises(UsageError, match="must be numbers"):
        controller().evaluate({"a": odd, "b": 1})
    with pytest.raises(UsageError, match=r"must be numbers|not numbers"):
        controller().evaluate_batch({"a": [odd, 1], "b": [1, 1]})


def test_many_terms_take_the_general_way() -> None:
    terms = {f"t{i}": {"triangle": [i - 1, i, i + 1]} for i in range(9)}
    data = {
        "inputs": {"a": {"range": [0, 8], "terms": terms}},
        "outputs": {"c": {"range": [-1, 9], "terms": terms}},
        "rules": [f"if a is t{i} then c is t{i}" for i in range(9)],
    }
    c = Controller.from_dict(data)
    assert c.evaluate({"a": 3})["c"] == pytest.approx(3, abs=1e-9)
    assert c.evaluate_batch({"a": [3, 5]})["c"] == pytest.approx([3, 5])


def test_infer_is_the_whole_in_one_call() -> None:
    assert infer(controller(), {"a": 0, "b": 0}) == pytest.approx({"c": 2})
