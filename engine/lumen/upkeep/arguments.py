"""Check arguments of public functions; the errors name the argument (`what`) and the allowed values."""

from collections.abc import Mapping
from math import isfinite, isnan
from pathlib import Path
from typing import Any

from lumen.errors import UsageError


def need(value: Any, kind: type | tuple[type, ...], what: str, meant: str) -> None:
    """Raise UsageError if a value is not of a type in `kind`; a bool is accepted only if `kind` is bool.

    `meant` describes the type in the message.
    """
    if not isinstance(value, kind) or (isinstance(value, bool) and kind is not bool):
        raise UsageError(f"{what} must be {meant}, not {_shown(value)}")


def need_methods(value: Any, kind: type, what: str) -> None:
    """Raise UsageError if a value lacks a public method of the protocol `kind`."""
    if missing := missing_methods(value, kind):
        names = f"the method `{missing[0]}`" if len(missing) == 1 else f"the methods {', '.join(missing)}"
        protocol = f"{kind.__module__}.{kind.__name__}"
        raise UsageError(f"{what} needs {names} (`{protocol}`), which {_shown(value)} does not have")


def missing_methods(value: Any, kind: type) -> list[str]:
    """Return the names of the public methods of the protocol `kind` that a value lacks."""
    names = dir(value)
    return [name for name in vars(kind) if not name.startswith("_") and name not in names]


def need_map(value: Any, what: str) -> None:
    """Raise UsageError if a value is not a map with strings as keys."""
    need(value, Mapping, what, "a map")
    for key in value:
        need(key, str, f"each key of {what}", "a string")


def need_text(value: Any, what: str, *, empty: bool = False) -> None:
    """Raise UsageError if a value is not a string, or is empty although `empty` is False."""
    need(value, str, what, "a string")
    if not value and not empty:
        raise UsageError(f"{what} is empty")


def need_number(value: Any, what: str, *, finite: bool = True) -> None:
    """Raise UsageError if a value is not a number, or is NaN; with `finite` also if it is infinite."""
    try:
        sound = not isinstance(value, str | bytes | bool) and not isnan(value) and (not finite or isfinite(value))
    except (TypeError, ValueError, OverflowError):
        sound = False
    if not sound:
        raise UsageError(f"{what} must be a number, not {_shown(value)}")


def need_numbers(values: Any, what: str) -> None:
    """Raise UsageError if a value is not a map from strings to finite numbers."""
    need_map(values, what)
    for key, value in values.items():
        need_number(value, f"`{key}` of {what}")


def need_path(value: Any) -> Path:
    """Return a value as the path of a file. Raises UsageError if it is not a path."""
    need(value, (str, Path), "the path of a file", "a string or a Path")
    if "\0" in str(value):
        raise UsageError("the path of a file contains a character that is not allowed in paths")
    return Path(value)


def _shown(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 80 else f"{text[:77]}…"
