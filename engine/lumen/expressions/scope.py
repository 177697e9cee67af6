"""The values that an expression can use, and the limits of its size and of its values."""

from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import Any, NamedTuple

from lumen.expressions.kinds import FaultError
from lumen.language.machines import Answer, MachineDefinition
from lumen.talk.folding import MAX_TEXT_EXAMINED as MAX_TEXT_EXAMINED

MAX_EXPRESSION_LENGTH = 2_000
"""The greatest number of characters of an expression."""

MAX_TREE_DEPTH = 50
"""The greatest number of levels of an expression's tree."""

MAX_TEXT_LENGTH = 10_000
"""The greatest number of characters of a text that an expression or a template builds."""

MAX_COLLECTION_VALUES = 10_000
"""The greatest number of values in a list or map that an expression builds, nested ones included."""

MIN_INT, MAX_INT = -(2**63), 2**63 - 1
"""The range of whole numbers: 64 bits, as in CEL."""

_NOTHING: Mapping[str, Any] = MappingProxyType({})


def _nowhere(state: str) -> bool:
    return False


def no_draw(count: int) -> int:
    """Raise FaultError: the default for `draw`, because only actions advance the random generator."""
    raise FaultError("random values are not allowed here", "use `shuffle` and `pick` only in `assign`")


class Scope(NamedTuple):
    """The values of an expression's names, and the environment of its functions; all values are plain JSON data."""

    context: Mapping[str, Any] = _NOTHING
    event: Mapping[str, Any] | None = None
    """`{"name": …, "data": …}`, or None if no event has arrived."""
    state: Mapping[str, Any] = _NOTHING
    """The current state: `path`, `language` and `place`."""
    configuration: Callable[[str], bool] = _nowhere
    """Returns whether a state is active, for `In()`."""
    at: float = 0.0
    """The time of the event [s]."""
    language: str = ""
    """The current language, which selects among texts by language."""
    phrases: Mapping[str, Mapping[str, tuple[str, ...]]] = _NOTHING
    answers: Mapping[str, tuple[Answer, ...]] = _NOTHING
    epoch: float = 0.0
    """The time at which the clock was 0 [s since 1970, UTC]."""
    timezone: str = ""
    """The IANA name of the time zone for `hour()` and similar functions."""
    lists: Mapping[str, Sequence[Any]] = _NOTHING
    draw: Callable[[int], int] = no_draw
    """Returns a random number from 0 to one less than its argument."""
    machine: MachineDefinition | None = None
    """The machine with the rows of `hears` that `heard` reads; None if there are no such rows."""


ROOTS = ("context", "event", "state", "lists")
"""The names that an expression begins with; they are fields of `Scope`."""
