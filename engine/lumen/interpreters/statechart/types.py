"""Which values a context key keeps: those of its first value's type, or of its `types:` entry."""

from collections.abc import Callable, Mapping
from typing import Any

from lumen.errors import UsageError
from lumen.language.diagnostics import did_you_mean
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


_QUICK: Mapping[str, tuple[type, ...]] = {
    "null": (type(None),),
    "boolean": (bool,),
    "integer": (int,),
    "number": (int, float),
    "string": (str,),
    "array": (list, tuple),
    "object": (dict,),
}


class Check:
    """The JSON types that a context key may hold; `quick` are Python types that are certain to be among them."""

    __slots__ = ("names", "quick")

    def __init__(self, names: tuple[str, ...]) -> None:
        self.names = names
        self.quick = frozenset(kind for name in names for kind in _QUICK[name])

    def accepts(self, value: Any) -> bool:
        return any(_TESTS[name](value) for name in self.names)

    def __str__(self) -> str:
        return f"a {' or '.join(self.names)}"


def type_checks(machine: Machine) -> dict[str, Check | None]:
    """For each context key its check, None where anything goes.

    A first value of null without an entry in `types:` says nothing of what comes later. An integer may become any
    number, as in CEL.
    """
    allowed = {key: _allowed(value, machine.types.get(key)) for key, value in machine.context.items()}
    return {key: Check(names) if names else None for key, names in allowed.items()}


def fits(value: Any, check: Check | None) -> bool:
    """Whether a context key with that check may hold the value."""
    return check is None or type(value) in check.quick or check.accepts(value)


def checked(name: str, checks: Mapping[str, Check | None], given: Mapping[str, Any]) -> Mapping[str, Any]:
    """The values given for context keys of the machine of that name; raises UsageError where one does not fit."""
    for key, value in given.items():
        if key not in checks:
            hint = did_you_mean(key, checks)
            raise UsageError(f"`{name}` has no `{key}` in its context to be given" + f": {hint}" * bool(hint))
        if not fits(value, checks[key]):
            raise UsageError(f"`{key}` is {checks[key]} and can't be a {type_name(value)}")
    return given


def type_name(value: Any) -> str:
    """The JSON type of a value, in the words of JSON Schema."""
    return next((name for name, test in _TESTS.items() if name != "integer" and test(value)), type(value).__name__)


def _allowed(first: Any, schema: Mapping[str, Any] | None) -> tuple[str, ...]:
    if schema is not None:
        names = schema.get("type", ())
        names = (names,) if isinstance(names, str) else tuple(names)
        return names if all(name in _TESTS for name in names) else ()
    return () if first is None else (type_name(first),)
