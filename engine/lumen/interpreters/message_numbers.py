"""Numbers in the bodies of messages, which anybody may have sent."""

from collections.abc import Mapping, Sequence
from typing import Any

from lumen.language.numbers import is_finite_number


def number(value: object) -> float | None:
    """A finite number from somebody's message; None for anything else, and for an integer beyond all floats."""
    return float(value) if is_finite_number(value) else None


def number_at(body: object, path: Sequence[str]) -> float | None:
    """The finite number in that field of a body, None where there is none."""
    value: Any = body
    for step in path:
        value = value.get(step) if isinstance(value, Mapping) else None
    return number(value)
