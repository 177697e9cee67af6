"""Make objects of dataclasses from data of a file whose shape the schema has checked."""

from collections.abc import Callable, Mapping
from dataclasses import MISSING, fields, is_dataclass
from enum import Enum
from functools import cache
from types import UnionType
from typing import Any, TypeVar, get_args, get_origin

T = TypeVar("T")


def read_fields(kind: type[T], data: Mapping[str, Any], **given: Any) -> T:
    """Return an object of a dataclass, whose fields are read from the keys of their names.

    `given` are fields that the caller has read because their keys have other names or units. A field without a key, or
    with an empty one, gets its default. The annotation of a field decides how its value is read:
    - An `int` is converted from any number, such as a port `8080.0`; a member of an enumeration from its value.
    - A tuple is read from a list, or from one text; a mapping from a map.
    - A dataclass is read from a map; any other value becomes its first field.
    - A dataclass that may be None is None if a key without a default is absent.
    """
    readers: Mapping[str, Callable[[Any], Any]] = _readers(kind)  # type: ignore[arg-type]  # a class is hashable
    said = {key: value for key, value in data.items() if key in readers and key not in given and value is not None}
    return kind(**{name: readers[name](value) for name, value in said.items()}, **given)


@cache
def _readers(kind: type) -> Mapping[str, Callable[[Any], Any]]:
    """Return the function that reads each field of a dataclass."""
    return {each.name: _reader(each.type) for each in fields(kind)}


def _reader(declared: Any) -> Callable[[Any], Any]:
    """Return the function that reads a value of a declared type."""
    form, inner = get_origin(declared), get_args(declared)
    if form is UnionType and inner[1:] == (type(None),):
        return _optional(inner[0]) if is_dataclass(inner[0]) else _reader(inner[0])
    if form is tuple:
        item = _reader(inner[0])
        return lambda data: (item(data),) if isinstance(data, str) else tuple(map(item, data))
    if form is Mapping:
        value = _reader(inner[1])
        return lambda data: {key: value(each) for key, each in data.items()}
    if is_dataclass(declared):
        return lambda data: _object(declared, data)
    return declared if declared is int or (isinstance(declared, type) and issubclass(declared, Enum)) else _unchanged


def _optional(kind: Any) -> Callable[[Any], Any]:
    needed = {each.name for each in fields(kind) if each.default is MISSING and each.default_factory is MISSING}
    return lambda data: read_fields(kind, data) if needed <= data.keys() else None


def _object(kind: Any, data: Any) -> Any:
    return read_fields(kind, data) if isinstance(data, Mapping) else kind(data)


def _unchanged(data: Any) -> Any:
    return data
