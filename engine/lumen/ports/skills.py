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
        """Return the verb."""
        ...

    @property
    def arguments(self) -> Mapping[str, Any]:
        """Return JSON data that match the schema of the verb's arguments."""
        ...

    @property
    def cancelled(self) -> bool:
        """Return True if the call should end, because the robot no longer waits for it."""
        ...

    @property
    def row(self) -> VerbRow:
        """Return the row of the verb."""
        ...

    @property
    def now(self) -> float:
        """Return the time by the robot's clock [s]."""
        ...

    def section(self, kind: type[Settings]) -> Settings:
        """Return the settings of this type from lumen.yaml, as `Project.section` does.

        They are from the files that the robot used when it received the command; calls after a reload get new ones.
        """
        ...

    def wait(self, seconds: float) -> bool:
        """Wait that long by the robot's clock [s]; return True, or False at once if the call is or gets cancelled."""
        ...

    def wait_for(self, ready: Callable[[], bool], seconds: float = inf, within: float = inf) -> bool:
        """Wait until `ready` returns True or the call is cancelled; return the last result of `ready`.

        The wait ends after `seconds` [s] of the robot's clock, or `within` [s] of real time. `ready` is called at the
        start and the end of the wait, and after each call of `wake`.
        """
        ...

    def wake(self) -> None:
        """Make a wait evaluate its `ready` again; callable from any thread."""
        ...


class SkillPerformer(Protocol):
    """The code of a feature's verb: an object, or a module, with this function."""

    def perform(self, call: SkillCall, /) -> Mapping[str, Any] | None:
        """Perform the verb; return its result, JSON data that match the schema of the row, or None for an empty one.

        It should return soon after `call.cancelled` becomes true. Raises RobotError on failure. Any other exception
        counts as a failure too, and is logged with its traceback.
        """
        ...
