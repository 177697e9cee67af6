"""JSON of other tools: numbers that no expression of ours can hold are refused, and not carried along."""

import json
from math import isinf
from typing import Any, NoReturn

from lumen.expressions.scope import MAX_INT, MIN_INT

_MAX_INTEGER_DIGITS = 20
"""Characters of an integer of 64 bits; what is longer is a number with a point, as in JavaScript."""


def foreign_json(text: str | bytes) -> Any:
    """The data; raises ValueError for what is no JSON or holds too large a number, RecursionError where it nests."""
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
