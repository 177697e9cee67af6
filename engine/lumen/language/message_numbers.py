"""Numbers in the bodies of messages, which anybody may have sent."""

from collections.abc import Sequence

from lumen.language.json_paths import value_at
from lumen.language.numbers import is_finite_number


def number(value: object) -> float | None:
    """A finite number from somebody's message; None for anything else, and for an integer beyond all floats."""
    return float(value) if is_finite_number(value) else None


def number_at(body: object, path: Sequence[str]) -> float | None:
    """The finite number in that field of a body, None where there is none."""
    return number(value_at(body, path))
