"""Updates of values inside the maps of a context: by copies, because the maps may be shared."""

from collections.abc import Mapping, Sequence
from typing import Any

from lumen.errors import ExpressionError


def with_value(found: Any, name: str, within: Sequence[str], value: Any) -> dict[str, Any]:
    """Return a copy of the map `found`, called `name` in errors, with the value at the path of keys `within`.

    The last key may be new. Raises ExpressionError if anything before it is missing or not a map.
    """
    key, *rest = within
    if not isinstance(found, Mapping):
        raise ExpressionError(
            f"`{name}` is not a map, so it can't have `{key}`", hint=f"assign it a map first, `{name}: {{}}`"
        )
    inner = f"{name}.{key}"
    if rest and key not in found:
        raise ExpressionError(
            f"`{inner}` does not exist, so it can't have `{rest[0]}`", hint=f"assign it a map first, `{inner}: {{}}`"
        )
    return {**found, key: with_value(found[key], inner, rest, value) if rest else value}
