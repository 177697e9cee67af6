"""What was worked out of the same content before: of a project's files one is saved at a time.

Only the last result of each kind is kept. Whoever asks again shares it with all others, so nobody may change it.
"""

from collections.abc import Callable, Hashable
from typing import Any, TypeVar

T = TypeVar("T")

MAX_MEMOIZED = 10_000

_last: dict[Hashable, tuple[Any, Any]] = {}


def memoize(slot: Hashable, given: Any, make: Callable[[], T]) -> T:
    """What `make` made in this slot when last given an equal `given`, else what it makes now.

    `given` is all that the result depends on.
    """
    known = _last.get(slot)
    if known is not None and known[0] == given:
        return known[1]  # type: ignore[no-any-return]
    made = make()
    if len(_last) >= MAX_MEMOIZED:
        _last.clear()
    _last[slot] = given, made
    return made
