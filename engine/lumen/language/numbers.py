"""Test for numbers as JSON, YAML and the expressions define them: a bool is not a number, unlike in Python."""

from math import isfinite
from typing import TypeGuard


def is_number(value: object) -> TypeGuard[int | float]:
    """Return True for an int or a float, including NaN and infinity; False for a bool and anything else."""
    return isinstance(value, int | float) and not isinstance(value, bool)


def is_finite_number(value: object) -> TypeGuard[int | float]:
    """Return True for a number with a finite value that a float can hold."""
    try:
        return is_number(value) and isfinite(value)
    except OverflowError:  # an integer that is too large for a float
        return False
