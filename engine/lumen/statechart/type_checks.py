"""Types of context keys: a key keeps the type of its first value, or that of its `types:` entry."""

from collections.abc import Callable, Mapping
from typing import Any

from lumen.errors import UsageError
from lumen.expressions.json_schema import JsonSchema
from lumen.language.diagnostics import did_you_mean
from lumen.language.machines import MachineDefinition
from lumen.language.numbers import is_number

_TESTS: Mapping[str, Callable[[Any], bool]] = {
    "null": lambda v: v is None,
    "boolean": lambda v: isinstance(v, bool),
    "integer": lambda v: not isinstance(v, bool) and (isinstance(v, int) or (isinstance(v, float) and v.is_integer())),
    "number": is_number,
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


_NOTES = {
    "type",
    "title",
    "description",
    "default",
    "examples",
    "deprecated",
    "readOnly",
    "writeOnly",
    "$comment",
    "$id",
}
"""Keywords that don't restrict a value further than its type."""


class TypeCheck:
    """The values that a context key may hold: those of its types that also fit its JSON Schema, if `types:` has one.

    A value whose exact Python type is in `quick` needs no further check.
    """

    __slots__ = ("_schema", "names", "quick")

    def __init__(self, names: tuple[str, ...], schema: Mapping[str, Any] | None = None) -> None:
        self.names = names
        self.quick = frozenset(() if schema else (kind for name in names for kind in _QUICK[name]))
        self._schema = JsonSchema(schema) if schema else None

    def accepts(self, value: Any) -> bool:
        """Return True if the key may hold the value."""
        if self.names and not any(_TESTS[name](value) for name in self.names):
            return False
        return self._schema is None or self._schema.fits(value) or not self._faults(value)

    def refusal(self, value: Any, verb: str = "be") -> str:
        """Return why a key can't hold that value, to follow the key's name; `verb` is `be` or `become`."""
        if self.names and not any(_TESTS[name](value) for name in self.names):
            return f"is {self} and can't {verb} {_with_article(type_name(value))}"
        shown = repr(value)
        return f"can't {verb} {shown[:40]}: {self._faults(value)[0]}"

    def _faults(self, value: Any) -> list[str]:
        """Return the schema's errors for the value; empty if the schema itself is invalid, which lint reports."""
        try:
            return [error.message[:100] for error in self._schema.errors(value)] if self._schema else []
        except RecursionError:
            return []

    def __str__(self) -> str:
        return _with_article(" or ".join(self.names))


def type_checks(machine: MachineDefinition) -> dict[str, TypeCheck | None]:
    """Return the check of each context key, None for a key that accepts any value.

    A key that begins as null, without an entry in `types:`, accepts any value. An integer may become any number, as in
    CEL.
    """
    return {key: _check(value, machine.types.get(key)) for key, value in machine.context.items()}


def fits(value: Any, check: TypeCheck | None) -> bool:
    """Return True if a context key with that check may hold the value."""
    return check is None or type(value) in check.quick or check.accepts(value)


def refusal(value: Any, check: TypeCheck | None) -> str:
    """Return why a context key with that check can't hold a value that does not fit."""
    assert check is not None  # without a check everything fits
    return check.refusal(value)


def checked(name: str, checks: Mapping[str, TypeCheck | None], given: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return `given`, the values for context keys of the machine called `name`.

    Raises UsageError if the machine has no such key, or a value does not fit.
    """
    for key, value in given.items():
        if key not in checks:
            hint = did_you_mean(key, checks)
            raise UsageError(f"`{name}` has no key `{key}` in its context" + f": {hint}" * bool(hint))
        if not fits(value, checks[key]):
            raise UsageError(f"`{key}` {refusal(value, checks[key])}")
    return given


def type_name(value: Any) -> str:
    """Return the JSON Schema type of a value, `number` for an integer; its Python type if it is not JSON."""
    return next((name for name, test in _TESTS.items() if name != "integer" and test(value)), type(value).__name__)


def _check(first: Any, schema: Mapping[str, Any] | None) -> TypeCheck | None:
    if schema is None:
        return None if first is None else TypeCheck((type_name(first),))
    said = schema.get("type")
    names = tuple(said) if isinstance(said, list | tuple) else (said,)
    names = names if all(isinstance(name, str) and name in _TESTS for name in names) else ()
    whole = None if schema.keys() <= _NOTES else schema
    return TypeCheck(names, whole) if names or whole else None


def _with_article(name: str) -> str:
    return f"an {name}" if name[:1] in "aeiou" else f"a {name}"
