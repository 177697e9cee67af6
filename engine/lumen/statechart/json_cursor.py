"""JSON data from outside, read part by part: each error names the part that is malformed."""

from collections.abc import Mapping
from typing import Any

from lumen.errors import SnapshotError, UsageError
from lumen.language.numbers import is_finite_number


class JsonCursor:
    """A part of a snapshot with its path; each reading method raises SnapshotError if the part has another type."""

    __slots__ = ("data", "place")

    def __init__(self, data: Any, place: str = "") -> None:
        self.data, self.place = data, place

    def __getitem__(self, key: str) -> "JsonCursor":
        """Return the part at a key; raise SnapshotError if the key is missing."""
        self.items()
        if key not in self.data:
            raise self.refused(f"lacks `{key}`")
        return self.below(key)

    def optional(self, key: str) -> "list[tuple[str, JsonCursor]]":
        """Return the parts of the map at a key; an empty list if the key is missing, as in older data."""
        return self[key].items() if any(key == known for known, _ in self.items()) else []

    def below(self, key: object) -> "JsonCursor":
        """Return the part at a key or index that is known to exist."""
        return JsonCursor(self.data[key], f"{self.place}.{key}".lstrip("."))

    def items(self) -> "list[tuple[str, JsonCursor]]":
        """Return the parts of a map whose keys are strings."""
        if not isinstance(self.data, Mapping) or not all(isinstance(key, str) for key in self.data):
            raise self.refused("should be a map with strings as keys")
        return [(key, self.below(key)) for key in self.data]

    def rows(self) -> "list[JsonCursor]":
        """Return the parts of a list."""
        if not isinstance(self.data, list | tuple):
            raise self.refused("should be a list")
        return [self.below(index) for index in range(len(self.data))]

    def text(self) -> str:
        """Return the part as a string."""
        if not isinstance(self.data, str):
            raise self.refused("should be a string")
        return self.data

    def texts(self) -> list[str]:
        """Return the part as a list of strings."""
        return [row.text() for row in self.rows()]

    def number(self) -> float:
        """Return the part as a finite number."""
        if not is_finite_number(self.data):
            raise self.refused("should be a number")
        return float(self.data)

    def count(self) -> int:
        """Return the part as an integer that is 0 or more."""
        if isinstance(self.data, bool) or not isinstance(self.data, int) or self.data < 0:
            raise self.refused("should be a whole number of at least 0")
        return self.data

    def plain(self) -> Any:
        """Return a copy of the part, which may be any JSON data."""
        try:
            return plain(self.data, self.place)
        except UsageError as error:
            raise SnapshotError(f"the snapshot is damaged: {error}") from None

    def refused(self, reason: str) -> SnapshotError:
        """Return an error with the path of this part and the reason."""
        return SnapshotError(f"the snapshot is damaged: {f'`{self.place}`' if self.place else 'it'} {reason}")


def plain(value: Any, place: str) -> Any:
    """Return a copy of JSON data with lists for tuples; raise UsageError with the path of a value that is not JSON."""
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
