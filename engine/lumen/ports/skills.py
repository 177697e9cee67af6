"""The code of a verb that a feature adds, and one call of it."""

from collections.abc import Callable, Mapping
from math import inf
from typing import Any, Protocol, TypeVar

from lumen.feature import VerbRow

Settings = TypeVar("Settings")


class SkillCall(Protocol):
    """One call of a performer, which runs in a thread of its own."""

    @property
    def skill(self) -> str:
        """The verb."""
        ...

    @property
    def arguments(self) -> Mapping[str, Any]:
        """JSON data that fit the schema of the verb's arguments."""
        ...

    @property
    def cancelled(self) -> bool:
        """Whether the call should end: the robot does not wait for it any more."""
        ...

    @property
    def row(self) -> VerbRow:
        """The row of the verb."""
        ...

    @property
    def now(self) -> float:
        """The time by the robot's clock [s]."""
        ...

    def section(self, kind: type[Settings]) -> Settings:
        """Return the settings of this type from lumen.yaml, as `Project.section` does.

        They are those of the files that the robot used when it was given the command: a later call has others after a
        reload.
        """
        ...

    def wait(self, seconds: float) -> bool:
        """Wait that long by the robot's clock; return False, at once, if the call is or gets cancelled."""
        ...

    def wait_for(self, ready: Callable[[], bool], seconds: float = inf, within: float = inf) -> bool:
        """Wait until the call is cancelled or `ready` returns True, which is what this returns.

        It ends after so many `seconds` of the robot's clock, and `within` so many of real time. `ready` is called when
        the wait begins, and after each call of `wake`.
        """
        ...

    def wake(self) -> None:
        """Have a wait look at its `ready` again, from any thread."""
        ...


class SkillPerformer(Protocol):
    """The code of a feature's verb: an object, or a module, with this function."""

    def perform(self, call: SkillCall, /) -> Mapping[str, Any] | None:
        """Perform the verb; return its result, JSON data that fit the schema of the row.

        It should return soon after `call.cancelled` turned true. Raises RobotError if it failed. Any other exception
        counts as a failure too, and is logged with its traceback.
        """
        ...
