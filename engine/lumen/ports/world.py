"""The world around a robot: the hall with its visitors, and the time."""

from collections.abc import Mapping
from typing import Any, Protocol, runtime_checkable

from lumen.language.stories import Visitor


@runtime_checkable
class Hall(Protocol):
    """A world in which visitors can be placed; a robot with these methods is its own hall.

    `FeelsTouch`, `HearsVisitors`, `PretendsSkills` and `HasCharger` are abilities that only some halls have.
    """

    def place(self, visitor: Visitor | None) -> None:
        """Place or move a visitor, or (None) remove them."""
        ...

    def face(self) -> tuple[float, float] | None:
        """Return the position of the visitor's face in the top camera's image [px]; None if it is not visible."""
        ...


@runtime_checkable
class FeelsTouch(Protocol):
    """A hall whose visitors can touch the robot."""

    def touch(self, sensor: str, pressed: bool) -> None:
        """Press or release a tactile sensor. Raises UsageError if that is impossible."""
        ...


@runtime_checkable
class HearsVisitors(Protocol):
    """A hall whose robot notices that a visitor speaks."""

    def sound(self) -> None:
        """Let the visitor be heard: a robot that can locate sounds may look there."""
        ...


@runtime_checkable
class PretendsSkills(Protocol):
    """A hall whose robot can perform the verbs of features and projects without their code, as a story specifies."""

    @property
    def runs_no_skills(self) -> bool:
        """Return True if the robot never runs their code, not even outside of a story."""
        ...

    def set_skills(self, ends: Mapping[str, Mapping[str, Any] | str]) -> None:
        """Set how verbs end from now on: with a result, or by `fails` or `hangs`."""
        ...


@runtime_checkable
class HasCharger(Protocol):
    """A hall with a charger for the robot."""

    def plug(self, plugged: bool) -> None:
        """Plug the charger in, or unplug it. Raises UsageError if that is impossible."""
        ...


@runtime_checkable
class Clock(Protocol):
    """The time of the exhibition, real or simulated."""

    def now(self) -> float:
        """Return the time [s], which never decreases."""
        ...

    def wait(self, until: float) -> None:
        """Return when `now()` has reached `until` [s]; a simulated clock simulates the time in between."""
        ...


@runtime_checkable
class Dozes(Protocol):
    """A clock that can sleep in real time and be woken."""

    def doze(self, until: float) -> float:
        """Sleep until `now()` would be `until` [s], or until `hurry` is called; return the time [s]."""
        ...

    def hurry(self) -> None:
        """End the current sleep or wait; callable from any thread."""
        ...


@runtime_checkable
class HasSpeed(Protocol):
    """A clock that runs at a multiple of real time."""

    speed: float | None
    """The multiple; None for as fast as possible."""


@runtime_checkable
class MeasuresPace(Protocol):
    """A clock that measures whether the machine keeps up with its speed."""

    @property
    def realtime(self) -> float:
        """Return the part of its speed that it reached recently: 1 for the full speed."""
        ...
