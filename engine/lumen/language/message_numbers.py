"""Numbers in the bodies of messages, which any program may have sent."""

from collections.abc import Sequence

from lumen.language.json_paths import value_at
from lumen.language.numbers import is_finite_number


def number(value: object) -> float | None:
    """Return a finite number as a float; None for any other value, and for an integer beyond the range of floats."""
    return float(value) if is_finite_number(value) else None


def number_at(body: object, path: Sequence[str]) -> float | None:
    """Return the finite number in that field of a body; None if the field holds no such number."""
    return number(value_at(body, path))
