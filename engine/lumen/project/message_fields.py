"""The fields of a message as its JSON Schema declares them, for transports that send values in order, without names."""

from collections.abc import Mapping
from enum import StrEnum
from typing import Any, NamedTuple

from lumen.language.numbers import is_number


class FieldKind(StrEnum):
    """The type of a field, if the schema allows only one; else `MIXED`."""

    NUMBER = "number"
    INTEGER = "integer"
    STRING = "string"
    BOOLEAN = "boolean"
    MIXED = ""


class SchemaField(NamedTuple):
    """A property of a message's schema."""

    name: str
    """The name of the property."""
    kind: FieldKind
    """The kind of its values."""
    low: float | None = None
    """The minimum of a number; None if the schema declares none."""
    high: float | None = None
    """The maximum of a number; None if the schema declares none."""


def message_fields(schema: Mapping[str, Any] | None) -> Mapping[str, SchemaField]:
    """Return the fields by name, in the order of the schema; none if the schema is None or has no properties."""
    rows = (schema or {}).get("properties")
    return {name: _field(name, row) for name, row in rows.items()} if isinstance(rows, Mapping) else {}


def _field(name: str, row: Any) -> SchemaField:
    if not isinstance(row, Mapping):
        return SchemaField(name, FieldKind.MIXED)
    kind, options = row.get("type"), row.get("enum")
    if kind is None and isinstance(options, list) and options and all(isinstance(o, str) for o in options):
        kind = "string"
    known = FieldKind(kind) if isinstance(kind, str) and kind in {*FieldKind} else FieldKind.MIXED
    return SchemaField(name, known, _number(row.get("minimum")), _number(row.get("maximum")))


def _number(value: Any) -> float | None:
    return float(value) if is_number(value) else None
