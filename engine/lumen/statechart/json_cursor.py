"""JSON data from outside, piece by piece, each with its place: an error names the piece that is not as it should be."""

from collections.abc import Mapping
from typing import Any

from lumen.errors import SnapshotError, UsageError
from lumen.language.numbers import is_finite_number


class JsonCursor:
    """A piece of a snapshot; every reading raises SnapshotError where it is something else."""

    __slots__ = ("data", "place")

    def __init__(self, data: Any, place: str = "") -> None:
        self.data, self.place = data, place

    def __getitem__(self, key: str) -> "JsonCursor":
        """What stands under a key that has to be there."""
        self.items()
        if key not in self.data:
            raise self.refused(f"lacks `{key}`")
        return self.below(key)

    def optional(self, key: str) -> "list[tuple[str, JsonCursor]]":
        """What stands under a key that older data do not have."""
        return self[key].items() if any(key == known for known, _ in self.items()) else []

    def below(self, key: object) -> "JsonCursor":
        return JsonCursor(self.data[key], f"{self.place}.{key}".lstrip("."))

    def items(self) -> "list[tuple[str, JsonCursor]]":
        if not isinstance(self.data, Mapping) or not all(isinstance(key, str) for key in self.data):
            raise self.refused("should be a map with strings as keys")
        return [(key, self.below(key)) for key in self.data]

    def rows(self) -> "list[JsonCursor]":
        if not isinstance(self.data, list | tuple):
            raise self.refused("should be a list")
        return [self.below(index) for index in range(len(self.data))]

    def text(self) -> str:
        if not isinstance(self.data, str):
            raise self.refused("should be a string")
        return self.data

    def texts(self) -> list[str]:
        return [row.text() for row in self.rows()]

    def number(self) -> float:
        if not is_finite_number(self.data):
            raise self.refused("should be a number")
        return float(self.data)

    def count(self) -> int:
        if isinstance(self.data, bool) or not isinstance(self.data, int) or self.data < 0:
            raise self.refused("should be a whole number of at least 0")
        return self.data

    def plain(self) -> Any:
        try:
            return plain(self.data, self.place)
        except UsageError as error:
            raise SnapshotError(f"the snapshot is damaged: {error}") from None

    def refused(self, reason: str) -> SnapshotError:
        """An error that says what is wrong with this piece."""
        return SnapshotError(f"the snapshot is damaged: {f'`{self.place}`' if self.place else 'it'} {reason}")


def plain(value: Any, place: str) -> Any:
    """A copy of JSON data, with lists for tuples; raises UsageError with the place of what is none."""
    try:
        return _plain(value, place)
    except RecursionError:
        raise UsageError(f"`{place}` is nested too deeply") from None


def _plain(value: Any, place: str) -> Any:
    match value:
        case None | bool() | str():
            return value
        case int() | float() if is_finite_number(value):
            return value
        case Mapping():
            for key in value:
                if not isinstance(key, str):
                    raise UsageError(f"`{place}` has the key {key!r}, which is not a string")
            return {key: _plain(item, f"{place}.{key}") for key, item in value.items()}
        case list() | tuple():
            return [_plain(item, f"{place}.{index}") for index, item in enumerate(value)]
        case int() | float():
            raise UsageError(f"`{place}` is {'too large' if isinstance(value, int) else value}, which JSON can't hold")
    raise UsageError(f"`{place}` is a {type(value).__name__}, which JSON can't hold")
