"""Resolve plain scalars by the core schema of YAML 1.2."""

import re
from math import inf, nan
from typing import Any

_NULL = frozenset(("", "~", "null", "Null", "NULL"))
_BOOL = {"true": True, "True": True, "TRUE": True, "false": False, "False": False, "FALSE": False}
_INT = re.compile(r"[-+]?[0-9]+")
_OCT = re.compile(r"0o[0-7]+")
_HEX = re.compile(r"0x[0-9a-fA-F]+")
_FLOAT = re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?")
_INF = re.compile(r"([-+]?)\.(inf|Inf|INF)")
_NAN = frozenset((".nan", ".NaN", ".NAN"))

MAX_DIGITS = 250
"""The maximum number of digits of an integer; a longer one is read as a float, which may be infinite."""


def resolve(text: str) -> Any:
    """Return the value of a plain scalar by the YAML 1.2 core schema (10.3.2): None, a bool, a number or the text."""
    if text in _NULL:
        return None
    if text in _BOOL:
        return _BOOL[text]
    if text[0] not in "+-.0123456789":
        return text
    if _INT.fullmatch(text):
        return int(text) if len(text) < MAX_DIGITS else float(text)
    if _OCT.fullmatch(text):
        return _integer(text[2:], 8)
    if _HEX.fullmatch(text):
        return _integer(text[2:], 16)
    if _FLOAT.fullmatch(text):
        return float(text)
    if match := _INF.fullmatch(text):
        return -inf if match[1] == "-" else inf
    return nan if text in _NAN else text


def _integer(digits: str, base: int) -> float:
    return int(digits, base) if len(digits) < MAX_DIGITS else inf
