"""Each kind of term: its shape at known points, the same for numbers and arrays, never outside 0 to 1."""

from math import exp, inf, isnan, sqrt

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lumen.fuzzy.arithmetic import NUMBERS, arrays
from lumen.fuzzy.memberships import MEMBERSHIP_FUNCTIONS, membership
from lumen.fuzzy.weighted import INVERSE_MEMBERSHIPS, value
from lumen.language.controllers import TERM_PARAMETERS, VALUE_TERMS, Term
from tests.tables import for_each

CASES = [
    ("triangle", (0, 4, 10), {-1: 0, 0: 0, 2: 0.5, 4: 1, 7: 0.5, 11: 0}),
    ("triangle", (0, 0, 10), {-1: 0, 0: 1, 5: 0.5}),
    ("triangle", (-inf, 4, 10), {-99: 1, 4: 1, 7: 0.5}),
    ("trapezoid", (0, 2, 6, 10), {1: 0.5, 2: 1, 5: 1, 8: 0.5, 10: 0}),
    ("trapezoid", (0, 2, 6, inf), {1: 0.5, 1e6: 1}),
    ("gaussian", (5, 2), {5: 1, 7: exp(-0.5), 3: exp(-0.5)}),
    ("gaussian-product", (4, 1, 6, 2), {4: 1, 5: 1, 6: 1, 3: exp(-0.5), 8: exp(-0.5)}),
    ("bell", (5, 2, 3), {5: 1, 7: 0.5, 3: 0.5, 9: 1 / 65}),
    ("sigmoid", (5, 2), {5: 0.5, 6: 1 / (1 + exp(-2)), 1e9: 1, -1e9: 0}),
    ("sigmoid", (5, -2), {6: 1 / (1 + exp(2))}),
    ("sigmoid-difference", (2, 9, 9, 8), {5: 1, -5: 0, 15: 0}),
    ("sigmoid-product", (2, 9, -9, 8), {5: 1, -5: 0, 15: 0}),
    ("ramp", (0, 10), {-1: 0, 5: 0.5, 11: 1}),
    ("ramp", (10, 0), {-1: 1, 5: 0.5, 11: 0}),
    ("rectangle", (2, 4), {1.9: 0, 2: 1, 4: 1, 4.1: 0}),
    ("s-shape", (0, 10), {0: 0, 2.5: 0.125, 5: 0.5, 7.5: 0.875, 10: 1}),
    ("z-shape", (0, 10), {0: 1, 2.5: 0.875, 5: 0.5, 7.5: 0.125, 10: 0}),
    ("pi-shape", (0, 2, 6, 10), {1: 0.5, 4: 1, 8: 0.5}),
    ("spike", (5, 10), {5: 1, 6: exp(-1), 4: exp(-1)}),
    ("cosine", (5, 10), {5: 1, 2.5: 0.5, 0: 0, -1: 0}),
    ("concave", (5, 8), {8: 1, 9: 1, 5: 0.5, 2: 1 / 3}),
    ("concave", (5, 2), {1: 1, 5: 0.5, 8: 1 / 3}),
    ("semi-ellipse", (0, 10), {5: 1, 0: 0, 10: 0, 2: 0.8}),
    ("arc", (0, 10), {0: 0, 10: 1, 5: sqrt(0.75), 11: 1, -1: 0}),
    ("arc", (10, 0), {0: 1, 10: 0, 5: sqrt(0.75)}),
    ("binary", (5, inf), {4.9: 0, 5: 1, 6: 1}),
    ("binary", (5, -inf), {5: 1, 6: 0}),
    ("discrete", (0, 0, 5, 1, 10, 0.5), {-1: 0, 2.5: 0.5, 5: 1, 7.5: 0.75, 99: 0.5}),
    ("discrete", (0, 0, 5, 0, 5, 1, 9, 1), {4: 0, 5: 1, 6: 1}),
    ("discrete", (0, 0, 0, 1, 9, 1), {-1: 0, 0: 1, 6: 1}),
    ("discrete", (4, 0.5), {0: 0.5, 4: 0.5, 6: 0.5}),
]


@for_each(("kind", "parameters", "points"), CASES)
def test_a_shape_at_known_points(kind: str, parameters: tuple[float, ...], points: dict[float, float]) -> None:
    shape = membership(NUMBERS, Term("t", kind, parameters))
    assert [shape(float(x)) for x in points] == pytest.approx(list(points.values()), abs=1e-9)


def test_every_kind_has_a_shape_and_a_case() -> None:
    assert (
        set(MEMBERSHIP_FUNCTIONS) == set(TERM_PARAMETERS) - {*VALUE_TERMS, "function"} == {kind for kind, _, _ in CASES}
    )


def test_the_height_scales_the_shape() -> None:
    assert membership(NUMBERS, Term("t", "ramp", (0.0, 10.0), height=0.5))(5.0) == 0.25


@given(st.sampled_from(CASES), st.lists(st.floats(-50, 50), min_size=1, max_size=20))
def test_numbers_and_arrays_agree_within_0_and_1(
    case: tuple[str, tuple[float, ...], dict[float, float]], xs: list[float]
) -> None:
    term = Term("t", case[0], tuple(map(float, case[1])))
    one, many = membership(NUMBERS, term), membership(arrays(), term)
    values = [one(x) for x in xs]
    assert np.broadcast_to(many(np.array(xs)), (len(xs),)) == pytest.approx(values, abs=1e-12)
    assert all(0.0 <= v <= 1.0 for v in values)


@given(st.sampled_from(sorted(INVERSE_MEMBERSHIPS)), st.floats(0.02, 0.98), st.sampled_from([1.0, 0.5]))
def test_a_monotonic_shape_read_backwards(kind: str, part: float, height: float) -> None:
    parameters = next(p for k, p, _ in CASES if k == kind)
    term = Term("t", kind, tuple(map(float, parameters)), height)
    x = value(NUMBERS, term)(part * height, ())
    assert membership(NUMBERS, term)(x) == pytest.approx(part * height, abs=1e-9)
    assert value(arrays(), term)(np.array([part * height]), ()) == pytest.approx([x])


def test_a_flat_sigmoid_has_no_value_read_backwards() -> None:
    flat = Term("t", "sigmoid", (3.0, 0.0))
    assert isnan(value(NUMBERS, flat)(0.4, ()))
    assert np.isnan(value(arrays(), flat)(np.array([0.4]), ())).all()
