"""The kinds of values, and the ways in which an evaluation fails."""

from collections.abc import Mapping
from typing import Any

NULL, BOOLEAN, NUMBER, TEXT, LIST, MAP = "null", "boolean", "number", "text", "list", "map"
KINDS = frozenset((NULL, BOOLEAN, NUMBER, TEXT, LIST, MAP))
KIND_DESCRIPTIONS = {
    NULL: "null", BOOLEAN: "true or false", NUMBER: "a number", TEXT: "a text", LIST: "a list", MAP: "a map",
}  # fmt: skip

_KIND_OF: Mapping[type, str] = {
    type(None): NULL, bool: BOOLEAN, int: NUMBER, float: NUMBER, str: TEXT, list: LIST, tuple: LIST, dict: MAP,
}  # fmt: skip


class FaultError(Exception):
    """An evaluation that can't go on: why, and what would be right."""

    def __init__(self, message: str, hint: str = "") -> None:
        self.message, self.hint = message, hint
        super().__init__(message)


class WrongKindError(Exception):
    """The operand of that number (from 0) of the node that is evaluated is not of a kind `wanted`."""

    def __init__(self, operand: int, value: Any, *wanted: str) -> None:
        self.operand, self.kind, self.wanted = operand, kind_of(value), wanted
        super().__init__()


class MismatchError(Exception):
    """The two operands of a sign don't go together."""

    def __init__(self, left: Any, right: Any) -> None:
        self.left, self.right = kind_of(left), kind_of(right)
        super().__init__()


def kind_of(value: Any) -> str:
    """One of KINDS; raises FaultError for what is not JSON data."""
    kind = _KIND_OF.get(type(value))
    if kind is not None:
        return kind
    for base, name in ((str, TEXT), (int, NUMBER), (float, NUMBER), (Mapping, MAP), (list, LIST), (tuple, LIST)):
        if isinstance(value, base):
            return name
    raise FaultError("an expression can't use this value", "the context and events can contain only JSON data")
