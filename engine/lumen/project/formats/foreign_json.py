"""Read JSON of other tools, refusing numbers that no expression of Lumen can hold."""

import json
from math import isinf
from typing import Any, NoReturn

from lumen.expressions.scope import MAX_INT, MIN_INT

_MAX_INTEGER_DIGITS = 20
"""The digits of a 64-bit integer; a longer one is read as a floating-point number, as in JavaScript."""


def foreign_json(text: str | bytes) -> Any:
    """Return the data of a JSON text.

    Raises ValueError for invalid JSON, NaN, infinity or a number that is too large, and RecursionError for data that is
    nested too deeply.
    """
    return json.loads(text, parse_constant=_refuse, parse_int=_integer, parse_float=_number)


def _integer(text: str) -> float:
    if len(text) <= _MAX_INTEGER_DIGITS and MIN_INT <= (value := int(text)) <= MAX_INT:
        return value
    return _number(text)


def _number(text: str) -> float:
    value = float(text)
    if isinf(value):
        _refuse(text)
    return value


def _refuse(text: str) -> NoReturn:
    raise ValueError(f"`{text[:40]}` is not a number")
