"""What was worked out of the same content before: of a project's files one is saved at a time.

Only the last result of each kind is kept. Whoever asks again shares it with all others, so nobody may change it. All of
it can be packed for a process that comes later.
"""

import pickle
from collections.abc import Callable, Hashable
from typing import Any, TypeVar

T = TypeVar("T")

MAX_MEMOIZED = 10_000

_last: dict[Hashable, tuple[Any, Any]] = {}
_unpacked: set[Hashable] = set()
"""The slots that still hold what was unpacked."""
_asked: set[Hashable] = set()
"""The slots that somebody asked for since `begin`."""


class Same:
    """Equal to another only where both hold the very same object: of what never changes, and is long to compare."""

    __slots__ = ("value",)

    def __init__(self, value: object) -> None:
        self.value = value

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Same) and other.value is self.value

    def __hash__(self) -> int:
        return id(self.value)


def last(slot: Hashable) -> Any:
    """What was made in this slot last, whatever it was given; None where nothing was."""
    return _last.get(slot, (None, None))[1]


def memoize(slot: Hashable, given: Any, make: Callable[[], T]) -> T:
    """What `make` made in this slot when last given an equal `given`, else what it makes now.

    `given` is all that the result depends on.
    """
    _asked.add(slot)
    known = _last.get(slot)
    if known is not None and known[0] == given:
        return known[1]  # type: ignore[no-any-return]
    made = make()
    if len(_last) >= MAX_MEMOIZED:
        _last.clear()
        _unpacked.clear()
        _asked.clear()
        _asked.add(slot)
    _last[slot] = given, made
    _unpacked.discard(slot)
    return made


def begin() -> None:
    """From now on note what is asked for."""
    _asked.clear()


def packed() -> bytes:
    """What is remembered in the slots that were asked for since `begin`."""
    return pickle.dumps({slot: _last[slot] for slot in _asked if slot in _last}, pickle.HIGHEST_PROTOCOL)


def unpack(packed: bytes) -> None:
    """Remember what was packed by the same engine; raises any exception where it is something else."""
    remembered = pickle.loads(packed)
    _last.update(remembered)
    _unpacked.update(remembered)


def newly_made() -> float:
    """The part of the slots that were asked for since `begin` whose content was not unpacked (0..1)."""
    return len(_asked - _unpacked) / len(_asked) if _asked else 0.0
