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
    """The failure of an evaluation.

    `message` is the reason; `hint` says what would be right, and may be empty.
    """

    def __init__(self, message: str, hint: str = "") -> None:
        self.message, self.hint = message, hint
        super().__init__(message)


class WrongKindError(Exception):
    """The error of an operand that has none of the kinds `wanted`.

    `operand` is the operand's index in the evaluated node; -1 is the node itself.
    """

    def __init__(self, operand: int, value: Any, *wanted: str) -> None:
        self.operand, self.kind, self.wanted = operand, kind_of(value), wanted
        super().__init__()


class MismatchError(Exception):
    """The error of an operator whose two operands have kinds that it cannot combine."""

    def __init__(self, left: Any, right: Any) -> None:
        self.left, self.right = kind_of(left), kind_of(right)
        super().__init__()


def kind_of(value: Any) -> str:
    """Return the kind of a value, one of KINDS; raise FaultError if the value is not JSON data."""
    kind = _KIND_OF.get(type(value))
    if kind is not None:
        return kind
    for base, name in ((str, TEXT), (int, NUMBER), (float, NUMBER), (Mapping, MAP), (list, LIST), (tuple, LIST)):
        if isinstance(value, base):
            return name
    raise FaultError("an expression can't use this value", "the context and events can contain only JSON data")
