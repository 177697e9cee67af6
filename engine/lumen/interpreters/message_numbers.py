"""Numbers in the bodies of messages, which anybody may have sent."""

from collections.abc import Mapping, Sequence
from math import isfinite
from typing import Any


def number(value: object) -> float | None:
    """A finite number from somebody's message; None for anything else, and for an integer beyond all floats."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    try:
        found = float(value)
    except OverflowError:
        return None
    return found if isfinite(found) else None


def number_at(body: object, path: Sequence[str]) -> float | None:
    """The finite number in that field of a body, None where there is none."""
    value: Any = body
    for step in path:
        value = value.get(step) if isinstance(value, Mapping) else None
    return number(value)
