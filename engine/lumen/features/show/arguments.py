"""Bodies as OSC messages (OSC 1.0): fields as arguments, with the types in their schema."""

from collections.abc import Mapping, Sequence
from typing import Any

from pythonosc.osc_message_builder import BuildError, OscMessageBuilder
from pythonosc.osc_packet import OscPacket, ParseError

from lumen.errors import ModuleError
from lumen.language.numbers import is_finite_number, is_number
from lumen.project.message_fields import FieldKind, SchemaField


def message_of(address: str, body: Any, fields: Sequence[SchemaField]) -> bytes:
    """Return the body's fields as a message to `address`. Raises ModuleError if a field is missing or does not fit."""
    builder = OscMessageBuilder(address)
    for field in fields:
        if not isinstance(body, Mapping) or field.name not in body:
            raise ModuleError(f"the body has no `{field.name}`")
        kind, value = _argument(field, body[field.name])
        builder.add_arg(value, kind)
    try:
        return bytes(builder.build().dgram)
    except (BuildError, UnicodeEncodeError, OverflowError) as error:
        raise ModuleError(f"it cannot be written as OSC: {error}") from None


def messages_of(data: bytes) -> list[tuple[str, list[Any]]]:
    """Return a datagram's messages, including those in bundles. Raises ModuleError if it is not OSC."""
    try:
        return [(timed.message.address, list(timed.message.params)) for timed in OscPacket(data).messages]
    except (ParseError, RecursionError, ValueError, IndexError, OverflowError) as error:
        raise ModuleError(f"it is not OSC: {error}") from None


def body_of_arguments(arguments: Sequence[Any], fields: Sequence[SchemaField]) -> dict[str, Any]:
    """Return the arguments by field name. Raises ModuleError if their number or types do not match the fields."""
    if len(arguments) != len(fields):
        names = ", ".join(field.name for field in fields) or "none"
        raise ModuleError(f"arguments in the message: {len(arguments)}; fields of the route: {len(fields)} ({names})")
    return {field.name: _value(field, value) for field, value in zip(fields, arguments, strict=True)}


def _argument(field: SchemaField, value: Any) -> tuple[str, Any]:
    number = is_number(value)
    match field.kind:
        case FieldKind.NUMBER if number:
            return OscMessageBuilder.ARG_TYPE_FLOAT, float(value)
        case FieldKind.INTEGER if number and value == int(value):
            small = -(2**31) <= value < 2**31
            return OscMessageBuilder.ARG_TYPE_INT if small else OscMessageBuilder.ARG_TYPE_INT64, int(value)
        case FieldKind.BOOLEAN if isinstance(value, bool):
            return OscMessageBuilder.ARG_TYPE_TRUE if value else OscMessageBuilder.ARG_TYPE_FALSE, value
        case FieldKind.STRING if isinstance(value, str) and "\0" not in value:
            return OscMessageBuilder.ARG_TYPE_STRING, value
    raise ModuleError(
        f"`{field.name}` cannot be an OSC argument: its type must be {field.kind or 'number, string or boolean'}"
    )


def _value(field: SchemaField, value: Any) -> Any:
    """Convert an argument to the field's type, because desks send integers as floats, and booleans as 1 and 0.

    Raises ModuleError if that is impossible.
    """
    number = is_finite_number(value)
    match field.kind:
        case FieldKind.NUMBER if number:
            return value
        case FieldKind.INTEGER if number and value == int(value):
            return int(value)
        case FieldKind.BOOLEAN if isinstance(value, bool) or (number and value in (0, 1)):
            return bool(value)
        case FieldKind.STRING if isinstance(value, str):
            return value
    raise ModuleError(
        f"its argument for `{field.name}` has the wrong type: it must be {field.kind or 'number, string or boolean'}"
    )
