"""What the runtime asks of the world: three seams, and the readings that cross them."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

from lumen.language.commands import MotorCommand, Say
from lumen.language.events import Event
from lumen.language.motions import MotionDefinition
from lumen.language.routes import Route, Size
from lumen.language.stories import Visitor


class Sense(StrEnum):
    """The five kinds of data that Lumen Server acquires in parallel."""

    IMAGE = "image"
    JOINT = "joint"
    SONAR = "sonar"
    TACTILE = "tactile"
    BATTERY = "battery"


class PixelSource(Protocol):
    """Renders or fetches a frame: Shape (height, width, 3), uint8 RGB.

    `size` [px] is that of the images wanted now, None for the camera's own. A robot that can't give it for a frame that
    is taken already gives that frame as it is, and the next ones in that size.
    """

    def __call__(self, size: Size | None = None) -> "NDArray[np.uint8]": ...


@dataclass(frozen=True, slots=True)
class Image:
    """A frame that is made only when `pixels` is called."""

    time: float
    pixels: PixelSource


class Whereabouts(NamedTuple):
    """Where a robot believes to be, from where it started: x forward, y left [m], theta to the left [rad].

    It adds up its steps, and looks at nothing: it may really be `doubt` [m] from there.
    """

    x: float = 0.0
    y: float = 0.0
    theta: float = 0.0
    doubt: float = 0.0


@dataclass(frozen=True, slots=True)
class Joints:
    """Measured angles [rad, hands 0..1] and stiffness [0..1], in the order of `names`.

    What a robot feels of itself besides, where it does: each motor's `temperature` [degrees Celsius] in that order, its
    inertial unit and the weight on its soles, by ALMemory's names and in its units; and where it believes to be.
    """

    time: float
    names: tuple[str, ...]
    angles: tuple[float, ...]
    stiffness: tuple[float, ...]
    temperature: tuple[float, ...] = ()
    inertial: Mapping[str, float] = field(default_factory=dict)
    fsr: Mapping[str, float] = field(default_factory=dict)
    position: Whereabouts | None = None


@dataclass(frozen=True, slots=True)
class Sonar:
    """Distance of the nearest echo on either side [m]."""

    time: float
    left: float
    right: float


@dataclass(frozen=True, slots=True)
class Tactile:
    """1 where a sensor is pressed, else 0, in the order of `names`."""

    time: float
    names: tuple[str, ...]
    values: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Battery:
    """Charge [%] and where it goes."""

    time: float
    percentage: int
    plugged: bool
    charging: bool


NumericReading = Joints | Sonar | Tactile | Battery
Reading = Image | NumericReading


@dataclass(frozen=True, slots=True)
class Perform:
    """Play this motion; it is the value itself, so that a reload can't change it while it runs."""

    motion: MotionDefinition


@dataclass(frozen=True, slots=True)
class Aim:
    """Move these joints towards angles [rad] at most at `speed` (a fraction of their greatest): NAOqi's `setAngles`."""

    angles: Mapping[str, float]
    speed: float = 0.3


@dataclass(frozen=True, slots=True)
class Record:
    """Listen for `duration` [s]; then the robot raises `RECORDED` with what it heard."""

    name: str
    duration: float


RobotCommand = MotorCommand | Say | Perform | Aim | Record
"""What a robot understands."""


class Robot(Protocol):
    """A body. Nothing here blocks, and nothing here raises for what the robot can't do: that is an answer.

    `start` is answered through `poll` by `done.command.ID`, `error.command.ID` (data: `{"reason": …}`) or
    `cancelled.command.ID`; `Aim` is not answered. `poll` also returns what the robot noticed by itself
    (`ROBOT_EVENTS`), each with `at` [s] on the robot's clock.
    """

    def start(self, id: str, command: RobotCommand) -> None: ...

    def cancel(self, id: str) -> None: ...

    def poll(self) -> Sequence[Event]: ...

    def begun(self) -> Sequence[str]:
        """The ids of the commands that began since the last call; the others that were started wait."""
        ...

    def read(self, sense: Sense) -> Reading | None:
        """The newest reading of a sense, None where the robot lacks it."""
        ...

    def close(self) -> None: ...


class Sole(NamedTuple):
    """Where a foot stands in the world [m], and what it bears [N]."""

    x: float
    y: float
    load: float


class Strain(NamedTuple):
    """How a body fares at one moment.

    `played` is how far along its motion it is [s], `tilt` how far the torso leans [rad]. `touching` are pairs of its
    own links that press into each other; `exhausted` the joints whose motors give all they can; `behind` is how far
    joints are from where they are wanted [rad].
    """

    played: float
    tilt: float
    touching: frozenset[tuple[str, str]]
    soles: Mapping[str, Sole]
    exhausted: frozenset[str]
    behind: Mapping[str, float]


class Subject(Robot, Protocol):
    """A simulated robot that can be examined while it moves."""

    def advance(self, dt: float) -> None:
        """Live `dt` [s]."""
        ...

    def strain(self) -> Strain: ...


class Hall(Protocol):
    """What a story may do to a simulated world."""

    def place(self, visitor: Visitor | None) -> None:
        """Put a visitor there, move them, or (None) take them away."""
        ...

    def face(self) -> tuple[float, float] | None:
        """Where the visitor's face stands in the top camera's image now [px], None where it can't be seen."""
        ...

    def touch(self, sensor: str, pressed: bool) -> None:
        """Press or release a tactile sensor."""
        ...

    def plug(self, plugged: bool) -> None:
        """Put the charger into the robot, or take it out."""
        ...


class Clock(Protocol):
    """The exhibition's time."""

    def now(self) -> float:
        """[s], never going back."""
        ...

    def wait(self, until: float) -> None:
        """Return when `now()` has reached `until`; a simulated world lives through the time in between."""
        ...


class Message(NamedTuple):
    """What a subscriber is handed; `body` is JSON data."""

    key: str
    body: Any
    reply_to: str = ""
    correlation_id: str = ""


MessageHandler = Callable[[Message], None]


class Bus(Protocol):
    """Messages by topic: `*` in a pattern stands for one word of the key, `#` for any number."""

    def carry(self, routes: Mapping[str, Route]) -> None:
        """Carry what goes and comes under these keys as their routes say, from now on; other keys as telemetry."""
        ...

    def prepare(self, routes: Mapping[str, Route]) -> None:
        """Make ready for `carry` and for subscribing to the routes that come in, so that neither has to wait then.

        This may wait for the network: it is for a thread that nobody waits for. From then on subscribing waits for
        nothing. Raises BusError where the broker refuses one of the routes.
        """
        ...

    def subscribe(self, pattern: str, handler: MessageHandler) -> Callable[[], None]:
        """Hand every matching message to `handler`, one at a time, in the order published; returns the undoing.

        An exception in a handler is logged and ends neither the bus nor the publisher.
        """
        ...

    def publish(
        self, key: str, body: Any, *, reply_to: str = "", correlation_id: str = "", ttl: float | None = None
    ) -> None:
        """Send a body (JSON data); safe from any thread. Raises BusError once closed, or for what is not JSON data.

        It never waits for a handler that runs on another thread, nor for the network. Where the bus has no thread of
        its own (`memory://`), who finds nobody delivering delivers: a handler may run inside `publish`, so it should
        do no more than enqueue.
        """
        ...

    def reply(self, message: Message, body: Any) -> None:
        """Answer to where a message wants its answer, under its `correlation_id`; nothing where it wants none.

        `reply_to` is a key (`avatar…`, `lumen…`) or, on a broker, the name of a queue, as modules of 2015 use it.
        """
        ...

    def close(self) -> None:
        """Deliver what was published and end; harmless when repeated."""
        ...
