"""Check for numbers that can't be used in calculations: YAML's `.nan` and `.inf`, and numbers that are too extreme."""

from collections.abc import Callable, Iterator, Mapping
from math import isfinite, isinf, isnan
from typing import Any

from lumen.language.diagnostics import ERROR, Code, NodePath
from lumen.language.numbers import is_number
from lumen.project.document_report import DocumentReport, prune

EXTREME_NUMBER = Code("extreme-number", "shape", ERROR, "a number is too large or too small to calculate with")
NOT_A_NUMBER = Code("not-a-number", "shape", ERROR, "a number is infinite, or not a number")
EMPTY_RANGE = Code("empty-range", "shape", ERROR, "a range is empty")
NOT_FINITE = Code("not-finite", "controllers", ERROR, "a number is infinite where only finite numbers are allowed")


LEAST_NUMBER, GREATEST_NUMBER = 1e-12, 1e12
"""A number of a controller is 0, or its size is within this range, so that squares and quotients are finite floats."""


def finite(value: float, report: DocumentReport, path: NodePath) -> bool:
    """Return True if a number is finite; otherwise, report the number."""
    try:
        sound = isfinite(value)
    except OverflowError:
        sound = False
    if not sound:
        shown = f".{value}".replace(".-", "-.") if isinstance(value, float) else ""
        what = f"`{shown}`" if shown else "a number with so many digits"
        report(NOT_A_NUMBER, path, f"{what} can't be used here", hint="write a finite number")
    return sound


def without_extremes(data: Any, report: DocumentReport, endless: Callable[[NodePath], bool]) -> Any:
    """Return the data without keys whose numbers a controller can't use; each is reported, and the document changed.

    `data` is that of the report's document. `endless` returns True for the paths at which a number may be infinite.
    """
    doomed = {_key(path) for path, number in numbers_in(data, ()) if not _usable(number, report, path, endless)}
    if not doomed:
        return data
    prune(report, doomed)
    return report.document.data


def _usable(number: float, report: DocumentReport, path: NodePath, endless: Callable[[NodePath], bool]) -> bool:
    if isinstance(number, float) and isnan(number):
        message = "`.nan` is not a number that a controller can use"
        report(NOT_A_NUMBER, path, message, hint="write a number")
    elif isinstance(number, float) and isinf(number):
        if endless(path):
            return True
        report(NOT_FINITE, path, "this number is infinite; it must be finite", hint="write a number")
    elif number and not LEAST_NUMBER <= abs(number) <= GREATEST_NUMBER:
        size = "large" if abs(number) > 1 else "small"
        hint = f"write 0, or a number between {LEAST_NUMBER:g} and {GREATEST_NUMBER:g}"
        report(EXTREME_NUMBER, path, f"this number is too {size} to calculate with", hint=hint)
    else:
        return True
    return False


def numbers_in(data: Any, path: NodePath) -> Iterator[tuple[NodePath, float]]:
    """Yield each number in nested maps and lists with its path, which begins with `path`."""
    if is_number(data):
        yield path, data
    children = data.items() if isinstance(data, Mapping) else enumerate(data) if isinstance(data, list) else ()
    for key, child in children:
        yield from numbers_in(child, (*path, key))


def _key(path: NodePath) -> NodePath:
    """Return the path of the key that contains a number; taking it out of a list would change the list's meaning."""
    while not isinstance(path[-1], str):
        path = path[:-1]
    return path
