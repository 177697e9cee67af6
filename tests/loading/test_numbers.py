"""Values that count as numbers in plain data."""

from math import inf, nan

import pytest

from lumen.language.numbers import is_finite_number, is_number


@pytest.mark.parametrize("value", [0, -1, 2.5, 10**400, nan, -inf])
def test_ints_and_floats_are_numbers(value: object) -> None:
    assert is_number(value)


@pytest.mark.parametrize("value", [True, False, None, "1", [1], 1j])
def test_booleans_and_texts_are_no_numbers(value: object) -> None:
    assert not is_number(value)
    assert not is_finite_number(value)


def test_a_finite_number_fits_a_float() -> None:
    assert is_finite_number(0)
    assert is_finite_number(-2.5)
    assert not any(map(is_finite_number, (nan, inf, -inf, 10**400)))
