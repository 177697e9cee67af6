"""What a loader made, as an instance of a class that can do more."""

from dataclasses import fields
from typing import Any, TypeVar

D = TypeVar("D")


def derived(into: type[D], value: Any) -> D:
    """The same value in a class derived from its own, whose fields are the same."""
    return into(**{field.name: getattr(value, field.name) for field in fields(value)})
