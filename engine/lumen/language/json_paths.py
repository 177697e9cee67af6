"""Read, replace and enumerate values in nested maps and lists."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any


def value_at(data: Any, path: Iterable[str]) -> Any:
    """Return the value at a path of nested maps, or None if the path leads to nothing."""
    for key in path:
        data = data.get(key) if isinstance(data, Mapping) else None
    return data


def schema_at(schema: Any, path: Iterable[str]) -> Any:
    """Return the JSON Schema of the property at a path of objects, or None if the schema declares none."""
    return value_at(schema, [key for name in path for key in ("properties", name)])


def with_value(data: Any, path: Sequence[str | int], value: Any) -> Any:
    """Return a copy of nested maps with `value` at `path`; anything else on that path is replaced by a map.

    All other values are shared with `data`, which stays as it is.
    """
    if not path:
        return value
    fields = data if isinstance(data, Mapping) else {}
    return {**fields, path[0]: with_value(fields.get(path[0]), path[1:], value)}


def values_in(data: Any) -> Iterator[Any]:
    """Yield a value, and all values in its maps and lists at any depth, in no particular order."""
    waiting = [data]
    while waiting:
        item = waiting.pop()
        yield item
        waiting += item.values() if isinstance(item, Mapping) else item if isinstance(item, list) else ()
