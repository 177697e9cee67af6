"""The values that an expression can use, and the limits of its size and of its values."""

from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import Any, NamedTuple

from lumen.expressions.kinds import FaultError
from lumen.language.machines import Answer, MachineDefinition
from lumen.talk.folding import MAX_TEXT_EXAMINED as MAX_TEXT_EXAMINED

MAX_EXPRESSION_LENGTH = 2_000
"""The most characters of an expression."""

MAX_TREE_DEPTH = 50
"""The most levels of an expression's tree."""

MAX_TEXT_LENGTH = 10_000
"""The most characters of a text that an expression or a template builds."""

MAX_COLLECTION_VALUES = 10_000
"""The most values in a list or map that an expression builds, nested ones included."""

MIN_INT, MAX_INT = -(2**63), 2**63 - 1
"""Whole numbers have 64 bits, as in CEL."""

_NOTHING: Mapping[str, Any] = MappingProxyType({})


def _nowhere(state: str) -> bool:
    return False


def no_draw(count: int) -> int:
    """Raise FaultError: the `draw` of scopes without random values, since only actions advance the random state."""
    raise FaultError("random values are not allowed here", "use `shuffle` and `pick` only in `assign`")


class Scope(NamedTuple):
    """The values that names and functions stand for; plain JSON data throughout.

    `event` is `{"name": …, "data": …}`, or None where no event has arrived; `state` has `path`, `language` and `place`.
    `configuration` is whether a state is active, for `In()`. `at` [s] is the time of the event, and `epoch` that of
    the clock's zero [s since 1970, in UTC], and `timezone` that of `hour()` and its kin. `language` is the one that
    `lookup` answers in; `draw` gives one of as many numbers, from 0.
    `machine` has the rows of `hears` that `heard` is about.
    """

    context: Mapping[str, Any] = _NOTHING
    event: Mapping[str, Any] | None = None
    state: Mapping[str, Any] = _NOTHING
    configuration: Callable[[str], bool] = _nowhere
    at: float = 0.0
    language: str = ""
    phrases: Mapping[str, Mapping[str, tuple[str, ...]]] = _NOTHING
    answers: Mapping[str, tuple[Answer, ...]] = _NOTHING
    epoch: float = 0.0
    timezone: str = ""
    lists: Mapping[str, Sequence[Any]] = _NOTHING
    draw: Callable[[int], int] = no_draw
    machine: MachineDefinition | None = None


ROOTS = ("context", "event", "state", "lists")
"""The names that an expression begins with; they are fields of `Scope`."""
