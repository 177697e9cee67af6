"""Norms, hedges and activation methods: their laws, and the same for numbers and arrays."""

from math import isnan, nan

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lumen.fuzzy.activations import ACTIVATE, COMPARISON_FUNCTIONS
from lumen.fuzzy.arithmetic import NUMBERS, arrays
from lumen.fuzzy.norms import NORM_FUNCTIONS, norm
from lumen.fuzzy.program import HEDGE_FUNCTIONS, hedged
from lumen.language import controllers
from lumen.language.controllers import ACTIVATIONS, COMPARISONS, S_NORMS, T_NORMS, Activation
from tests.tables import for_each

degree = st.one_of(st.floats(0, 1), st.sampled_from([0.0, 0.5, 1.0]))


def test_the_vocabulary_is_complete() -> None:
    assert set(NORM_FUNCTIONS) == {*T_NORMS, *S_NORMS}
    assert set(HEDGE_FUNCTIONS) == set(controllers.HEDGES)
    assert set(ACTIVATE) == set(ACTIVATIONS)
    assert set(COMPARISON_FUNCTIONS) == set(COMPARISONS)


@given(degree, degree)
@pytest.mark.parametrize("name", [*T_NORMS, *S_NORMS])
def test_a_norm_commutes_and_has_its_neutral_element(name: str, a: float, b: float) -> None:
    combine = norm(NUMBERS, name)
    assert combine(a, b) == pytest.approx(combine(b, a))
    neutral = 1.0 if name in T_NORMS else 0.0
    assert combine(a, neutral) == pytest.approx(a, abs=1e-12)
    assert float(norm(arrays(), name)(np.array(a), np.array(b))) == pytest.approx(combine(a, b))
    if name != "unbounded-sum":
        assert -1e-12 <= combine(a, b) <= 1.0 + 1e-12


@for_each(
    ("name", "value"),
    [
        ("minimum", 0.5), ("algebraic-product", 0.3), ("bounded-difference", 0.1), ("drastic-product", 0.0),
        ("einstein-product", 0.25), ("hamacher-product", 0.375), ("nilpotent-minimum", 0.5),
        ("maximum", 0.6), ("algebraic-sum", 0.8), ("bounded-sum", 1.0), ("drastic-sum", 1.0),
        ("einstein-sum", 1.1 / 1.3), ("hamacher-sum", 0.5 / 0.7), ("nilpotent-maximum", 1.0),
        ("normalized-sum", 1.0), ("unbounded-sum", 1.1),
    ],
)  # fmt: skip
def test_norms_of_one_half_and_three_fifths(name: str, value: float) -> None:
    assert norm(NUMBERS, name)(0.5, 0.6) == pytest.approx(value)


@for_each(
    ("hedge", "quarter", "three_quarters"),
    [
        ("any", 1.0, 1.0), ("not", 0.75, 0.25), ("extremely", 0.125, 0.875), ("seldom", 0.125**0.5, 1 - 0.125**0.5),
        ("somewhat", 0.5, 0.75**0.5), ("very", 0.0625, 0.5625),
    ],
)  # fmt: skip
def test_hedges(hedge: str, quarter: float, three_quarters: float) -> None:
    assert hedged(NUMBERS, (hedge,), 0.25) == pytest.approx(quarter)
    assert hedged(NUMBERS, (hedge,), 0.75) == pytest.approx(three_quarters)
    assert hedged(arrays(), (hedge,), np.array([0.25])) == pytest.approx(quarter)


def test_the_hedge_next_to_the_term_acts_first() -> None:
    assert hedged(NUMBERS, ("not", "very"), 0.5) == 0.75


@for_each(
    ("activation", "expected"),
    [
        (Activation(), [0.2, 0.8, 0.0, 0.5]),
        (Activation("first", rules=2), [0.2, 0.8, nan, nan]),
        (Activation("first", rules=1, threshold=0.3), [nan, 0.8, nan, nan]),
        (Activation("last", rules=2), [nan, 0.8, nan, 0.5]),
        (Activation("highest", rules=2), [nan, 0.8, nan, 0.5]),
        (Activation("lowest", rules=2), [0.2, nan, nan, 0.5]),
        (Activation("proportional"), [0.2 / 1.5, 0.8 / 1.5, nan, 0.5 / 1.5]),
        (Activation("threshold", threshold=0.5, comparison=">"), [nan, 0.8, nan, nan]),
        (Activation("threshold", threshold=0.5, comparison="<="), [0.2, nan, 0.0, 0.5]),
    ],
)
def test_which_rules_take_part(activation: Activation, expected: list[float]) -> None:
    degrees = [0.2, 0.8, 0.0, 0.5]
    method = ACTIVATE[activation.method]
    assert method(NUMBERS, activation, degrees) == pytest.approx(expected, nan_ok=True)
    columns = method(arrays(), activation, [np.array([d, d]) for d in degrees])
    assert [float(c[1]) for c in columns] == pytest.approx(expected, nan_ok=True)


def test_of_equal_rules_the_first_are_taken() -> None:
    chosen = ACTIVATE["highest"](NUMBERS, Activation("highest", rules=1), [0.5, 0.5])
    assert chosen[0] == 0.5
    assert isnan(chosen[1])


@given(st.floats(0, 4), st.floats(0, 4))
@pytest.mark.parametrize("name", [*T_NORMS, *S_NORMS])
def test_no_norm_fails_on_what_a_sum_without_bound_hands_on(name: str, a: float, b: float) -> None:
    for x, y in ((a, b), (0.0, 2.0), (2.0, 2.0), (1.0, 1.0)):
        with np.errstate(all="ignore"):
            many = norm(arrays(), name)(np.array([x]), np.array([y]))
        assert many == pytest.approx([norm(NUMBERS, name)(x, y)], rel=1e-9, nan_ok=True)


@given(st.floats(0, 4), st.lists(st.sampled_from(controllers.HEDGES), min_size=1, max_size=4))
def test_no_row_of_hedges_fails(x: float, hedges: list[str]) -> None:
    many = hedged(arrays(), tuple(hedges), np.array([x]))
    assert np.broadcast_to(many, (1,)) == pytest.approx([hedged(NUMBERS, tuple(hedges), x)])
