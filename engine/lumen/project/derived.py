"""Convert a loaded value to an instance of a derived class with more methods."""

from dataclasses import fields
from typing import Any, TypeVar

D = TypeVar("D")


def derived(into: type[D], value: Any) -> D:
    """Return the same value as an instance of `into`, a class derived from its own with the same fields."""
    return into(**{field.name: getattr(value, field.name) for field in fields(value)})
