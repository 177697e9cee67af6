"""Commands as JSON data, as the journal keeps them: a later Lumen with more fields writes the same for the same."""

from collections.abc import Mapping, Sequence
from dataclasses import MISSING, Field, fields, is_dataclass
from functools import cache
from typing import Any


def command_data(value: Any) -> Any:
    """`{Start: {id: d1, command: {Say: {text: Hello}}}}`: names and fields, without those that are as usual."""
    if is_dataclass(value) and not isinstance(value, type):
        said = ((field.name, getattr(value, field.name), _usual(field)) for field in _compared(type(value)))
        return {type(value).__name__: {name: command_data(given) for name, given, usual in said if given != usual}}
    if isinstance(value, Mapping):
        return {str(key): command_data(item) for key, item in value.items()}
    if isinstance(value, Sequence) and not isinstance(value, str):
        return [command_data(item) for item in value]
    return value


@cache
def _compared(kind: Any) -> tuple[Field[Any], ...]:
    return tuple(field for field in fields(kind) if field.compare)


def _usual(field: Field[Any]) -> Any:
    if field.default_factory is not MISSING:
        return field.default_factory()
    return field.default


def started(command: Any) -> tuple[str, str, Mapping[str, Any]] | None:
    """The id, the kind (`Say`) and the fields of what a command begins, None where it begins nothing."""
    match command:
        case {"Start": {"id": str(id), "command": Mapping() as body}} if body:
            kind, said = next(iter(body.items()))
            return id, kind, said
    return None
