"""The interfaces of the runtime to the world: robot, bus and clock, and the readings that they exchange."""

from abc import abstractmethod
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from itertools import count
from math import inf
from os import urandom
from threading import Event as Signal
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol, TypeVar, runtime_checkable

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

from lumen.feature import VerbRow
from lumen.language.causes import UNKNOWN_ORIGIN, MessageOrigin
from lumen.language.commands import Do, MotorCommand, Say
from lumen.language.events import Event
from lumen.language.gestures import NO_GESTURES, GestureLibrary
from lumen.language.life import LifeStyle
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

    `size` [px] is the size wanted now, None for the camera's own. If a frame was already taken in another size, the
    robot may return it as it is, and the next frames in the wanted size.
    """

    def __call__(self, size: Size | None = None) -> "NDArray[np.uint8]": ...


@dataclass(frozen=True, slots=True)
class Image:
    """A frame that is made only when `pixels` is called."""

    time: float
    pixels: PixelSource


class Whereabouts(NamedTuple):
    """A robot's estimate of its position, relative to its start: x forward, y left [m], theta to the left [rad].

    It only adds up its steps: the real position may be `doubt` [m] away.
    """

    x: float = 0.0
    y: float = 0.0
    theta: float = 0.0
    doubt: float = 0.0


@dataclass(frozen=True, slots=True)
class Joints:
    """Measured angles [rad, hands 0..1] and stiffness [0..1], in the order of `names`.

    If the robot measures them, also: each motor's `temperature` [degrees Celsius] in that order, the inertial unit and
    the weight on its soles, with ALMemory's names and units, and the estimate of its position. `life` is how far it has
    moved joints of its own accord, beside where commands want them.
    """

    time: float
    names: tuple[str, ...]
    angles: tuple[float, ...]
    stiffness: tuple[float, ...]
    temperature: tuple[float, ...] = ()
    inertial: Mapping[str, float] = field(default_factory=dict)
    fsr: Mapping[str, float] = field(default_factory=dict)
    position: Whereabouts | None = None
    life: Mapping[str, float] = field(default_factory=dict)


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
    """Charge [%], and whether the battery is plugged in and charging."""

    time: float
    percentage: int
    plugged: bool
    charging: bool


NumericReading = Joints | Sonar | Tactile | Battery
Reading = Image | NumericReading


@dataclass(frozen=True, slots=True)
class Perform:
    """Play this motion. It holds the motion itself, so that a reload can't change it while it runs."""

    motion: MotionDefinition


@dataclass(frozen=True, slots=True)
class Aim:
    """Move these joints towards angles [rad], at most at `speed` (a fraction of the greatest): NAOqi's `setAngles`."""

    angles: Mapping[str, float]
    speed: float = 0.3


@dataclass(frozen=True, slots=True)
class Live:
    """Be alive in this style from now on, wherever nothing else moves the robot, and speak with these gestures.

    Nobody waits for it.
    """

    style: LifeStyle
    gestures: GestureLibrary = NO_GESTURES


@dataclass(frozen=True, slots=True)
class Record:
    """Listen for `duration` [s]; then the robot raises `RECORDED` with what it heard."""

    name: str
    duration: float


NativeCommand = MotorCommand | Say | Perform | Aim | Record | Live
"""The commands that each robot performs in its own way."""

RobotCommand = NativeCommand | Do
"""The commands of a robot. The verbs that features add (`Do`) are performed in the same way for every robot."""


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


@runtime_checkable
class Robot(Protocol):
    """A robot. No method blocks. If the robot can't do something, no method raises: an event says so.

    `start` is answered through `poll` by `done.command.ID`, `error.command.ID` (data: `{"reason": …}`) or
    `cancelled.command.ID`; `Aim` and `Live` are not answered. `poll` also returns what the robot noticed by itself
    (`robot_events`), each event with `at` [s] on the robot's clock.
    """

    def start(self, id: str, command: RobotCommand) -> None: ...

    def cancel(self, id: str) -> None: ...

    def poll(self) -> Sequence[Event]: ...

    def begun(self) -> Sequence[str]:
        """The ids of the commands that began since the last call; other started commands still wait."""
        ...

    def read(self, sense: Sense) -> Reading | None:
        """The newest reading of a sense, None if the robot does not have it."""
        ...

    def close(self) -> None: ...


class Sole(NamedTuple):
    """The position of a foot in the world [m], and the load on it [N]."""

    x: float
    y: float
    load: float


class Strain(NamedTuple):
    """The mechanical state of a robot at one moment.

    `played` is the time within its motion [s], `tilt` the angle of the torso from the vertical [rad]. `touching` are
    pairs of its own links that collide, `exhausted` the joints whose motors are at their limit, `behind` the distance
    of joints from their targets [rad].
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
        """Simulate `dt` [s]."""
        ...

    def strain(self) -> Strain: ...


@runtime_checkable
class Advances(Protocol):
    """A robot that lives only while its world is simulated."""

    def advance(self, dt: float) -> None:
        """Simulate `dt` [s]."""
        ...


@runtime_checkable
class Idles(Protocol):
    """A robot that can tell that nothing is happening to it."""

    @property
    def idle(self) -> bool:
        """Whether no command is under way, no event waits for `poll`, and no visitor is in front of it."""
        ...


@runtime_checkable
class OtherReading(Protocol):
    """A reading of a sense that a feature adds."""

    @property
    def time(self) -> float:
        """When it was measured [s], on the robot's clock."""
        ...


@runtime_checkable
class HasOtherSenses(Protocol):
    """A robot with senses that features add."""

    def read_other(self, sense: str) -> OtherReading | None:
        """The newest reading of the sense with that name, None if the robot does not have it."""
        ...


@runtime_checkable
class PerformsVerbs(Protocol):
    """A robot that performs the verbs of features itself, together with its other commands."""

    @property
    def verbs(self) -> Collection[str]:
        """The verbs that it can perform: those of the features that are installed beside it."""
        ...


@runtime_checkable
class Hall(Protocol):
    """A world in which visitors can be placed; a robot with these methods is its own hall.

    `FeelsTouch`, `HearsVisitors`, `PretendsSkills` and `HasCharger` are abilities that only some halls have.
    """

    def place(self, visitor: Visitor | None) -> None:
        """Place or move a visitor, or (None) remove them."""
        ...

    def face(self) -> tuple[float, float] | None:
        """The position of the visitor's face in the top camera's image now [px], None if it can't be seen."""
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
        """Let the visitor be heard: a robot that hears from where may look there."""
        ...


@runtime_checkable
class PretendsSkills(Protocol):
    """A hall whose robot performs the verbs of features and projects without their code, as a story says."""

    def set_skills(self, ends: Mapping[str, Mapping[str, Any] | str]) -> None:
        """Have verbs end so from now on: with a result, or by `fails` or `hangs`."""
        ...


@runtime_checkable
class HasCharger(Protocol):
    """A hall with a charger for the robot."""

    def plug(self, plugged: bool) -> None:
        """Plug the charger in, or unplug it. Raises UsageError if that is impossible."""
        ...


@runtime_checkable
class Clock(Protocol):
    """The exhibition's time."""

    def now(self) -> float:
        """[s], never going back."""
        ...

    def wait(self, until: float) -> None:
        """Return when `now()` has reached `until`; a simulated clock simulates the time in between."""
        ...


@runtime_checkable
class Dozes(Protocol):
    """A clock that can sleep in real time and be woken."""

    def doze(self, until: float) -> float:
        """Sleep until `now()` would be `until` [s], or until `hurry`; return the time [s]."""
        ...

    def hurry(self) -> None:
        """End the sleep or the wait that is under way, from any thread."""
        ...


@runtime_checkable
class HasSpeed(Protocol):
    """A clock that runs at a multiple of real time."""

    speed: float | None
    """The multiple; None for as fast as possible."""


@runtime_checkable
class MeasuresPace(Protocol):
    """A clock that measures how much of its speed the machine keeps."""

    @property
    def realtime(self) -> float:
        """The part of its speed that it kept of late: 1 if it kept all."""
        ...


class Message(NamedTuple):
    """A message as a subscriber receives it; `body` is JSON data.

    `id` tells it from every other message, `sender` is the program it comes from, empty where that is not known. `time`
    is when it was sent, as far as the sender said, else when it came [s since 1970, in UTC]. `cause` is what in a
    behaviour asked for it, as in `MessageOrigin`.
    """

    key: str
    body: Any
    reply_to: str = ""
    correlation_id: str = ""
    id: str = ""
    sender: str = ""
    time: float = 0.0
    cause: str = ""


MessageHandler = Callable[[Message], None]

Ability = TypeVar("Ability")

PREFIX, NUMBERS = urandom(5).hex(), count(1)
"""The parts of each message id: a prefix of this process, and a number."""

_new = tuple.__new__  # half the price of Outgoing(…), which each message pays


class Outgoing(NamedTuple):
    """A message as it is sent; `Bus.publish` and `MessageOrigin` describe the fields. `publish` fills in the `id`."""

    key: str
    body: Any
    reply_to: str = ""
    correlation_id: str = ""
    ttl: float | None = None
    id: str = ""
    sender: str = ""
    time: float = 0.0
    cause: str = ""


@runtime_checkable
class Bus(Protocol):
    """Messages by topic: `*` in a pattern stands for one word of the key, `#` for any number.

    A bus of your own inherits from this class and implements the methods without a body. What only some buses can do
    is a protocol of its own, such as `CountsDrops`: ask for it with `ability`.
    """

    def ability(self, kind: type[Ability]) -> Ability | None:
        """Return this bus as one with that ability; None if it lacks it. A wrapper passes the question inward."""
        return self if isinstance(self, kind) else None

    @abstractmethod
    def carry(self, routes: Mapping[str, Route]) -> None:
        """From now on, carry messages with these keys as their routes say, and all others as telemetry."""
        ...

    @abstractmethod
    def prepare(self, routes: Mapping[str, Route]) -> None:
        """Prepare `carry`, and subscribing to the incoming routes, so that neither has to wait later.

        This may wait for the network, so call it on a background thread. Afterwards subscribing does not wait.
        Raises BusError if the broker refuses one of the routes.
        """
        ...

    @abstractmethod
    def subscribe(self, pattern: str, handler: MessageHandler) -> Callable[[], None]:
        """Call `handler` with each matching message, one by one, in the order published; the result ends it.

        An exception in a handler is logged and ends neither the bus nor the publisher.
        """
        ...

    def publish(
        self,
        key: str,
        body: Any,
        *,
        reply_to: str = "",
        correlation_id: str = "",
        ttl: float | None = None,
        origin: MessageOrigin = UNKNOWN_ORIGIN,
    ) -> None:
        """Send a body (JSON data); safe from any thread. Raises BusError after `close`, or if it is not JSON data.

        The bus fills in what `origin` leaves empty: an id that no other message has, its own `sender`, and the time.
        """
        id, sender, time, cause = origin
        id = id or f"{PREFIX}-{next(NUMBERS)}"
        self.send(_new(Outgoing, (key, body, reply_to, correlation_id, ttl, id, sender, time, cause)))

    @abstractmethod
    def send(self, message: Outgoing) -> None:
        """Send a message as `publish` does.

        It never waits for a handler on another thread, nor for the network. A bus without its own thread (`memory://`)
        may run handlers inside `send`, if no other thread is delivering; so a handler should only enqueue.
        """
        ...

    @abstractmethod
    def reply(self, message: Message, body: Any) -> None:
        """Send an answer to the message's `reply_to`, with its `correlation_id`; does nothing without a `reply_to`.

        `reply_to` is a key (`avatar…`, `lumen…`) or, on a broker, the name of a queue, as in the modules of 2015.
        """
        ...

    @abstractmethod
    def close(self) -> None:
        """Deliver the published messages and end; a second call does nothing."""
        ...


@runtime_checkable
class BlockableBus(Protocol):
    """A bus whose broker may accept no messages for a while."""

    @property
    def blocked(self) -> str:
        """The resource that the broker lacks while it accepts no messages; empty while it accepts them."""
        ...


@runtime_checkable
class ReturningBus(Protocol):
    """A bus between processes that can say whether a published message has a receiver."""

    def returns(self, handler: Callable[[str], None]) -> None:
        """From now on, call `handler` with the key of each published message that has no receiver.

        The call may come on any thread; for messages published before `close`, it comes before `close` returns.
        """
        ...


@runtime_checkable
class SignsMessages(Protocol):
    """A bus whose messages carry the name of the program that sends them."""

    @property
    def sender(self) -> str: ...


@runtime_checkable
class CountsDrops(Protocol):
    """A bus that counts the messages that it dropped."""

    @property
    def dropped(self) -> Mapping[str, int]:
        """The number of dropped messages by key."""
        ...


@runtime_checkable
class KnowsListeners(Protocol):
    """A bus that can tell whether a message would have a receiver."""

    def heard(self, key: str) -> bool: ...


@runtime_checkable
class UsesBroker(Protocol):
    """A bus through a broker on a machine of the network."""

    @property
    def host(self) -> str:
        """The broker's machine."""
        ...

    @property
    def away(self) -> bool:
        """Whether the broker can't be reached now."""
        ...


@runtime_checkable
class EndsWithExhibition(Protocol):
    """A bus that an exhibition serves, and that ends with it."""

    @property
    def gone(self) -> Signal:
        """Set once the exhibition has ended."""
        ...
