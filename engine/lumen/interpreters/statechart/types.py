"""Which values a context key keeps: those of its first value's type, or of its `types:` entry."""

from collections.abc import Callable, Mapping
from typing import Any

from lumen.language.machines import Machine

_TESTS: Mapping[str, Callable[[Any], bool]] = {
    "null": lambda v: v is None,
    "boolean": lambda v: isinstance(v, bool),
    "integer": lambda v: not isinstance(v, bool) and (isinstance(v, int) or (isinstance(v, float) and v.is_integer())),
    "number": lambda v: isinstance(v, int | float) and not isinstance(v, bool),
    "string": lambda v: isinstance(v, str),
    "array": lambda v: isinstance(v, list | tuple),
    "object": lambda v: isinstance(v, Mapping),
}


def type_checks(machine: Machine) -> dict[str, tuple[str, ...]]:
    """For each context key the JSON types that it may hold; none where anything goes.

    A first value of null without an entry in `types:` says nothing of what comes later. An integer may become any
    number, as in CEL.
    """
    return {key: _allowed(value, machine.types.get(key)) for key, value in machine.context.items()}


def fits(value: Any, types: tuple[str, ...]) -> bool:
    """Whether a value is of one of these JSON types, or of any where there are none."""
    return not types or any(_TESTS[name](value) for name in types)


def type_name(value: Any) -> str:
    """The JSON type of a value, in the words of JSON Schema."""
    return next((name for name, test in _TESTS.items() if name != "integer" and test(value)), type(value).__name__)


def _allowed(first: Any, schema: Mapping[str, Any] | None) -> tuple[str, ...]:
    if schema is not None:
        names = schema.get("type", ())
        names = (names,) if isinstance(names, str) else tuple(names)
        return names if all(name in _TESTS for name in names) else ()
    return () if first is None else (type_name(first),)
