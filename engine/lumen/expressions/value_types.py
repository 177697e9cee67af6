"""Static types of values, derived from JSON Schemas."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from typing import Any

from lumen.expressions.kinds import BOOLEAN, KINDS, LIST, MAP, NULL, NUMBER, TEXT, FaultError, kind_of

JSON_TYPES = {
    "null": NULL, "boolean": BOOLEAN, "integer": NUMBER, "number": NUMBER, "string": TEXT, "array": LIST, "object": MAP,
}  # fmt: skip

_BEYOND = frozenset(("$ref", "$dynamicRef", "allOf", "anyOf", "oneOf", "if", "patternProperties"))


class FieldPresence(Enum):
    """The presence of a field: declared, declared and not required, or not declared at all."""

    SURE = "sure"
    OPTIONAL = "optional"
    UNDECLARED = "undeclared"


@dataclass(frozen=True)
class ValueType:
    """The kinds that a value may have."""

    kinds: frozenset[str] = KINDS
    schemas: tuple[Mapping[str, Any], ...] = ()
    """Alternative JSON Schemas that describe its fields or elements; empty if these are unknown."""

    def field(self, name: str) -> tuple["ValueType", FieldPresence]:
        """Return the type of a field, and its presence in the worst alternative."""
        if not self.schemas:
            return ANY, FieldPresence.SURE
        found = [_field(schema, name) for schema in self.schemas]
        presences = {presence for _, presence in found}
        for worst in (FieldPresence.UNDECLARED, FieldPresence.OPTIONAL):
            if worst in presences:
                return union(t for t, p in found if p is not FieldPresence.UNDECLARED), worst
        return union(t for t, _ in found), FieldPresence.SURE

    def fields(self) -> set[str]:
        """Return the names of all declared fields."""
        return {name for schema in self.schemas for name in schema.get("properties", ())}

    def element(self) -> "ValueType":
        """Return the type of the list's elements."""
        return union(type_of_schema(schema.get("items")) for schema in self.schemas)


ANY = ValueType()


def of(*kinds: str) -> ValueType:
    """Return the type of a value of one of these kinds, without schemas."""
    return ValueType(frozenset(kinds))


def union(types: Iterable[ValueType]) -> ValueType:
    """Return the type of a value that has any of these types; ANY if there are no types."""
    listed = list(types)
    if not listed:
        return ANY
    known = all(t.schemas or not t.kinds & {LIST, MAP} for t in listed)
    kinds = frozenset[str]().union(*(t.kinds for t in listed))
    return ValueType(kinds, tuple(s for t in listed for s in t.schemas) if known else ())


def type_of_schema(schema: object) -> ValueType:
    """Return the type that a JSON Schema declares; ANY if it has no type, or keywords that are not supported here."""
    if not isinstance(schema, Mapping) or not _BEYOND.isdisjoint(schema):
        return ANY
    if "const" in schema:
        return type_of_values([schema["const"]])
    if isinstance(schema.get("enum"), list):
        return type_of_values(schema["enum"])
    declared = schema.get("type")
    listed = [declared] if isinstance(declared, str) else declared if isinstance(declared, Sequence) else []
    kinds = frozenset(JSON_TYPES[name] for name in listed if name in JSON_TYPES)
    if not kinds and "properties" in schema:
        kinds = frozenset((MAP,))
    if not kinds:
        return ANY
    return ValueType(kinds, (schema,) if kinds & {LIST, MAP} else ())


def type_of_values(values: Iterable[Any]) -> ValueType:
    """Return the type of a value that is one of these; ANY if any of them is not JSON data."""
    try:
        return of(*(kind_of(value) for value in values))
    except FaultError:
        return ANY


def schema_of(value: Any) -> dict[str, Any]:
    """Return the JSON Schema of a context key that begins with `value`, which must be JSON data, and keeps its type."""
    names = {NULL: "null", BOOLEAN: "boolean", NUMBER: "number", TEXT: "string", LIST: "array", MAP: "object"}
    return {"type": names[kind_of(value)]}


def _field(schema: Mapping[str, Any], name: str) -> tuple[ValueType, FieldPresence]:
    properties = schema.get("properties")
    if not isinstance(properties, Mapping):
        return ANY, FieldPresence.SURE
    if name in properties:
        required = schema.get("required")
        optional = isinstance(required, Sequence) and name not in required
        return type_of_schema(properties[name]), FieldPresence.OPTIONAL if optional else FieldPresence.SURE
    others = schema.get("additionalProperties")
    if isinstance(others, Mapping):
        return type_of_schema(others), FieldPresence.OPTIONAL
    return ANY, FieldPresence.UNDECLARED
