"""The commands of a robot, the interface of every robot, and what only some robots can do."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple, Protocol, runtime_checkable

from lumen.language.commands import Do, MotorCommand, Say
from lumen.language.events import Event
from lumen.language.gestures import NO_GESTURES, GestureLibrary
from lumen.language.life import LifeStyle
from lumen.language.motions import MotionDefinition
from lumen.ports.readings import Reading, Sense


@dataclass(frozen=True, slots=True)
class Perform:
    """Play this motion. It holds the motion itself, so that a reload can't change it while it runs."""

    motion: MotionDefinition


@dataclass(frozen=True, slots=True)
class Aim:
    """Move these joints towards angles [rad], at most at `speed` (a fraction of the maximum): NAOqi's `setAngles`."""

    angles: Mapping[str, float]
    speed: float = 0.3


@dataclass(frozen=True, slots=True)
class Live:
    """Start idle life in this style, in all joints that nothing else moves, and speak with these gestures.

    The command has no end, so nothing waits for it.
    """

    style: LifeStyle
    gestures: GestureLibrary = NO_GESTURES


@dataclass(frozen=True, slots=True)
class Record:
    """Listen for `duration` [s]; then the robot raises `RECORDED` with the sound."""

    name: str
    duration: float


NativeCommand = MotorCommand | Say | Perform | Aim | Record | Live
"""The commands that each robot performs in its own way."""

RobotCommand = NativeCommand | Do
"""The commands of a robot; verbs added by features (`Do`) are performed in the same way for every robot."""


@runtime_checkable
class Robot(Protocol):
    """A robot. No method blocks, and none raises if the robot can't do something: an event reports that.

    `start` is answered through `poll` by `done.command.ID`, `error.command.ID` (data: `{"reason": …}`) or
    `cancelled.command.ID`; `Aim` and `Live` are not answered. `poll` also returns what the robot noticed by itself
    (`robot_events`), each event with `at` [s] on the robot's clock.
    """

    def start(self, id: str, command: RobotCommand) -> None:
        """Start a command; `poll` returns its outcome under that id."""
        ...

    def cancel(self, id: str) -> None:
        """Cancel the command with that id."""
        ...

    def poll(self) -> Sequence[Event]:
        """Return the events since the last call."""
        ...

    def begun(self) -> Sequence[str]:
        """Return the ids of the commands that began since the last call; other started commands still wait."""
        ...

    def read(self, sense: Sense) -> Reading | None:
        """Return the newest reading of a sense; None if the robot does not have it."""
        ...

    def close(self) -> None:
        """Release the robot."""
        ...


class Sole(NamedTuple):
    """A foot, seen in the world."""

    x: float
    """The x coordinate of the foot [m]."""
    y: float
    """The y coordinate of the foot [m]."""
    load: float
    """The load on the foot [N]."""


class Strain(NamedTuple):
    """The mechanical state of a robot at one moment."""

    played: float
    """The time within its motion [s]."""
    tilt: float
    """The angle of the torso from the vertical [rad]."""
    touching: frozenset[tuple[str, str]]
    """Pairs of its own links that collide."""
    soles: Mapping[str, Sole]
    exhausted: frozenset[str]
    """The joints whose motors are at their limit."""
    behind: Mapping[str, float]
    """The distances of joints from their targets [rad]."""


class Subject(Robot, Protocol):
    """A simulated robot that can be examined while it moves."""

    def advance(self, dt: float) -> None:
        """Simulate `dt` [s]."""
        ...

    def strain(self) -> Strain:
        """Return the mechanical state now."""
        ...


@runtime_checkable
class Advances(Protocol):
    """A robot that is active only while its world is simulated."""

    def advance(self, dt: float) -> None:
        """Simulate `dt` [s]."""
        ...


@runtime_checkable
class Idles(Protocol):
    """A robot that can report that nothing is happening to it."""

    @property
    def idle(self) -> bool:
        """Return True if no command runs, no event waits for `poll`, and no visitor is in front of the robot."""
        ...


@runtime_checkable
class OtherReading(Protocol):
    """A reading of a sense that a feature adds."""

    @property
    def time(self) -> float:
        """Return when the reading was measured [s], on the robot's clock."""
        ...


@runtime_checkable
class HasOtherSenses(Protocol):
    """A robot with senses that features add."""

    def read_other(self, sense: str) -> OtherReading | None:
        """Return the newest reading of the sense with that name; None if the robot does not have it."""
        ...


@runtime_checkable
class PerformsVerbs(Protocol):
    """A robot that performs the verbs of features itself, together with its other commands."""

    @property
    def verbs(self) -> Collection[str]:
        """Return the verbs that the robot can perform: those of the features installed with it."""
        ...
