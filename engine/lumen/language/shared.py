"""Values that all robots of a house can read, each written by one of them."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

SHARED = "shared"
"""What expressions call all of them, and the key of the context that holds them."""
SHARED_EVENT = "shared.changed"
"""What a behaviour hears of values that another robot has given them: its data are these, by name."""


@dataclass(frozen=True, slots=True)
class SharedKey:
    """A key of `shared:`: the robot that alone assigns it, the JSON type of its values, and the first of them."""

    owner: str
    type: str
    initial: Any


@dataclass(frozen=True, slots=True)
class SharedKeys:
    """The keys of `shared:` by name."""

    by_name: Mapping[str, SharedKey] = field(default_factory=dict)


def shared_schema(keys: Mapping[str, SharedKey]) -> dict[str, Any]:
    """Return the JSON Schema of all of them together."""
    properties = {name: {"type": key.type} for name, key in keys.items()}
    return {"type": "object", "properties": properties, "required": list(keys), "additionalProperties": False}


def first_values(keys: Mapping[str, SharedKey]) -> dict[str, Any]:
    """Return the values before any robot has assigned one."""
    return {name: key.initial for name, key in keys.items()}
