"""Bodies as payloads of MQTT: JSON, or one field as bare text."""

from typing import Any

import orjson

from lumen.errors import ModuleError
from lumen.project.message_fields import FieldKind, SchemaField


def payload_of(body: Any, field: SchemaField | None) -> bytes:
    """The body as JSON, or its field as bare text. Raises ModuleError for what can't be carried so."""
    if field is None:
        return _json(body)
    if not isinstance(body, dict) or field.name not in body:
        raise ModuleError(f"the body has no `{field.name}`")
    value = body[field.name]
    try:
        return value.encode() if isinstance(value, str) else _json(value)
    except UnicodeEncodeError:
        raise ModuleError(f"`{field.name}` contains half of a surrogate pair") from None


def body_of_payload(payload: bytes, field: SchemaField | None) -> Any:
    """What a payload says; raises ModuleError for what is no JSON, or no text."""
    if field and field.kind is FieldKind.STRING:
        try:
            return {field.name: payload.decode()}
        except UnicodeDecodeError:
            raise ModuleError("it is not UTF-8 text") from None
    try:
        value = orjson.loads(payload)
    except orjson.JSONDecodeError:
        raise ModuleError("it is not JSON") from None
    return {field.name: value} if field else value


def _json(value: Any) -> bytes:
    try:
        return orjson.dumps(value)
    except TypeError as error:
        raise ModuleError(f"it cannot be written as JSON: {error}") from None
