"""Reuse results that were computed from the same content: usually only one file of a project changes at a time.

Only the last result of each slot is kept. All callers share it, so don't change it. The results can be packed for
a later process.
"""

import pickle
from collections.abc import Callable, Hashable, Mapping
from dataclasses import fields, is_dataclass
from typing import Any, TypeVar

T = TypeVar("T")

MAX_MEMOIZED = 10_000

_last: dict[Hashable, tuple[Any, Any]] = {}
_unpacked: set[Hashable] = set()
"""The slots that `unpack` filled and that were not replaced since."""
_asked: set[Hashable] = set()
"""The slots that were requested since `begin`."""


class Same:
    """A wrapper that compares by identity, for immutable values that are slow to compare."""

    __slots__ = ("value",)

    def __init__(self, value: object) -> None:
        self.value = value

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Same) and other.value is self.value

    def __hash__(self) -> int:
        return id(self.value)


def last(slot: Hashable) -> Any:
    """Return the last result in this slot, whatever it was computed from; None if the slot is empty."""
    return _last.get(slot, (None, None))[1]


def memoize(slot: Hashable, given: Any, make: Callable[[], T]) -> T:
    """Return the last result of `make` in this slot if `given` was equal then, else compute it anew.

    `given` is all that the result depends on.
    """
    _asked.add(slot)
    known = _last.get(slot)
    if known is not None and known[0] == given and _of_the_same_types(known[0], given):
        made: T = known[1]
    else:
        made = make()
        if len(_last) >= MAX_MEMOIZED:
            for one in (_last, _unpacked, _asked):
                one.clear()
            _asked.add(slot)
        _unpacked.discard(slot)
    _last[slot] = given, made  # the next comparison is quick if it is of the same objects
    return made


def _of_the_same_types(one: Any, other: Any) -> bool:
    """Return whether two equal values also have the same types: to Python, `True` equals 1."""
    if one is other or type(one) is not type(other):
        return one is other
    if isinstance(one, Mapping):
        one, other = [*one.values()], [other[key] for key in one]
    elif is_dataclass(one):
        one, other = ([getattr(each, field.name) for field in fields(one) if field.compare] for each in (one, other))
    return not isinstance(one, list | tuple) or all(map(_of_the_same_types, one, other))


def begin() -> None:
    """Forget which slots were requested, to record them from now on."""
    _asked.clear()


def packed() -> bytes:
    """Return the contents of the slots that were requested since `begin`, as bytes for `unpack`."""
    return pickle.dumps({slot: _last[slot] for slot in _asked if slot in _last}, pickle.HIGHEST_PROTOCOL)


def unpack(packed: bytes) -> None:
    """Load results of `packed`. Call it only with bytes of the same engine: pickle may run code or raise any error."""
    remembered = pickle.loads(packed)
    _last.update(remembered)
    _unpacked.update(remembered)


def newly_made() -> float:
    """Return the share of the slots requested since `begin` that were not unpacked (0..1)."""
    return len(_asked - _unpacked) / len(_asked) if _asked else 0.0
