"""Values that all robots of a house can read, each written by one of them."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

SHARED = "shared"
"""The name of the shared values in expressions, and the key of the context that holds them."""
SHARED_EVENT = "shared.changed"
"""The event for values that another robot has assigned; its data are these values, by name."""


@dataclass(frozen=True, slots=True)
class SharedKey:
    """A key of `shared:`."""

    owner: str
    """The only robot that can assign the key."""
    type: str
    """The JSON type of the key's values."""
    initial: Any
    """The key's value before the robot assigns one."""


@dataclass(frozen=True, slots=True)
class SharedKeys:
    """The keys of `shared:` by name."""

    by_name: Mapping[str, SharedKey] = field(default_factory=dict)


def shared_schema(keys: Mapping[str, SharedKey]) -> dict[str, Any]:
    """Return the JSON Schema of all shared values together."""
    properties = {name: {"type": key.type} for name, key in keys.items()}
    return {"type": "object", "properties": properties, "required": list(keys), "additionalProperties": False}


def first_values(keys: Mapping[str, SharedKey]) -> dict[str, Any]:
    """Return the values before any robot has assigned one."""
    return {name: key.initial for name, key in keys.items()}
