"""Plain data with another value at a path."""

from collections.abc import Mapping, Sequence
from typing import Any


def with_value(data: Any, path: Sequence[str | int], value: Any) -> Any:
    """Return a copy of nested maps with `value` at `path`; what is no map on the way becomes one.

    All other values are shared with `data`, which stays as it is.
    """
    if not path:
        return value
    fields = data if isinstance(data, Mapping) else {}
    return {**fields, path[0]: with_value(fields.get(path[0]), path[1:], value)}
