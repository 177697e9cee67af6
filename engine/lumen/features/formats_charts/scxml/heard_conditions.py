"""Converts rows of `hears` to SCXML's conditions, `hears(_event.data.result, 'not dance') && (guard)`, and back."""

from lumen.expressions import unparse
from lumen.expressions.tree import Literal
from lumen.features.formats_charts.ecmascript import ScriptError

HEARS = "hears"
_AND, _END = " && (", ")"


def row_condition(key: str, guard: str) -> str:
    """Return the condition for a row with this key; `guard` is the row's own guard in ECMAScript, or empty."""
    return _asked(key) + (f"{_AND}{guard}{_END}" if guard else "")


def guard_in(key: str, condition: str) -> str:
    """Return the row's own guard from a `row_condition`, or empty. Raises ScriptError for any other condition."""
    asked = _asked(key)
    if condition == asked:
        return ""
    if condition.startswith(asked + _AND) and condition.endswith(_END):
        return condition.removeprefix(asked + _AND).removesuffix(_END)
    raise ScriptError(f"the condition of a row of `hears` must begin with `{asked}`")


def _asked(key: str) -> str:
    return f"{HEARS}(_event.data.result, {unparse(Literal(key))})"
