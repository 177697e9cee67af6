"""Values within the maps of a context: given by copies, as others may hold the maps too."""

from collections.abc import Mapping, Sequence
from typing import Any

from lumen.errors import ExpressionError


def with_value(found: Any, name: str, within: Sequence[str], value: Any) -> dict[str, Any]:
    """A copy of the map `found`, which is called `name`, with the value where the keys `within` lead.

    The last of them may be new. Raises ExpressionError where anything before it is missing, or no map.
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
