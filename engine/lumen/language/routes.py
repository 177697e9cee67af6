"""Routes: the messages that an exhibition sends and receives, and how each is transported."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Literal, NamedTuple

from lumen.feature import table
from lumen.language.diagnostics import NodePath

IMAGE, JOINT, SONAR, TACTILE, BATTERY = "image", "joint", "sonar", "tactile", "battery"
FACE, HEARD, COMMAND, STOP = "face", "heard", "command", "stop"

_MEANINGS: Mapping[str, str] = {
    FACE: "the position of a visitor's face in the camera's image; simulated visitors appear on it",
    HEARD: "the words of a visitor: spoken, typed, or from a story",
    COMMAND: "commands from other modules to the robot",
    STOP: "commands to rest or to stop, on a separate route",
}


def route_meanings() -> Mapping[str, str]:
    """Return the purpose of each route whose name has a meaning for Lumen; other names are free for the exhibition."""
    return {**{sense: str(row.meaning) for sense, row in table("senses").items()}, **_MEANINGS}


JSON_TYPE, JPEG_TYPE, FLOATS_TYPE = "application/json", "image/jpeg", "application/vnd.lumen.float32"
"""The forms in which a body may be sent to a broker: JSON, the bytes of a JPEG, joint angles as 32-bit floats."""


class Direction(StrEnum):
    """`in`: a module publishes and Lumen listens; `out`: Lumen publishes and modules listen."""

    IN = "in"
    OUT = "out"


class Carried(StrEnum):
    """The kind of a message, which decides its fate if the connection is slow, full or cut.

    Only the newest message of `telemetry` counts. A `command` is performed soon or not at all. A `stop` is a command
    that never waits behind others. No message of a `journal` is lost.
    """

    TELEMETRY = "telemetry"
    COMMAND = "command"
    STOP = "stop"
    JOURNAL = "journal"


DEFAULT_COMMAND_TTL = 5.0
"""The lifetime of a command if its route does not set one [s]."""
LONGEST_COMMAND_TTL = 10.0
"""The longest sensible lifetime of a command [s]: after that, people may have moved into the robot's way."""


MAX_RATE = 2_000.0
"""The default maximum rate of an outgoing route [1/s], which only a faulty loop exceeds."""
USUAL_RATE = 50.0
"""The default maximum rate of an incoming route [1/s], the rate of the exhibition's ticks."""


STOP_RATE = 200.0
"""The default maximum rate of incoming stops [1/s], high enough that no stop is lost among others."""


class Size(NamedTuple):
    """The size of an image [px]."""

    width: int
    height: int

    def __str__(self) -> str:
        return f"{self.width} x {self.height}"


SIZES = tuple(Size(320 * n // 2, 240 * n // 2) for n in (1, 2, 4, 8))
"""The sizes of NAO's camera images: NAOqi's kQQVGA to k4VGA."""

SHORTEST_IMAGE_INTERVAL = 0.033
"""The time between two images of NAO's cameras [s]: 30 a second."""


class RouteUse(NamedTuple):
    """The first place in a behaviour that uses a route."""

    file: str
    where: NodePath
    verb: Literal["hears", "publishes to"]


@dataclass(frozen=True, slots=True)
class Route:
    """A row of the route table in `lumen.yaml`."""

    name: str
    key: str
    """The routing key, which may contain `{robot}`."""
    direction: Direction
    schema: str = ""
    """The name of a file of `schemas/messages/`."""
    event: str = ""
    """The event that a message becomes for the behaviour."""
    every: float | None = None
    """The period of a sense [s]; None if the route sets none."""
    size: Size | None = None
    """The size of a sense's images; None for that of the camera."""
    ttl: float | None = None
    """The time for which a message is valid [s]; None if the route sets none."""
    keep: int | None = None
    """The maximum number of waiting messages; None if the route sets none."""
    carried: Carried = Carried.TELEMETRY
    must_arrive: bool = False
    """True if the sender keeps a message until the broker has it, and the receiver returns it unless it was handled."""
    latency: float = 0.15
    """The assumed age of a body without a `time` [s]."""
    most: float | None = None
    """The maximum rate of accepted messages [1/s]; None for the default, see `rate`."""
    alias: str = ""
    """A second key while one robot is on the bus: messages are sent under both and received under either."""
    of: str = ""
    """The sense that the route carries besides the sense's own route, with another period, size or form; else ""."""
    content_type: str = JSON_TYPE
    """The form of a body on a broker."""
    where: NodePath = field(default=(), compare=False)
    built_in: bool = field(default=False, compare=False)
    uses: tuple[RouteUse, ...] = field(default=(), compare=False)

    def key_for(self, robot: str) -> str:
        """Return the routing key with the robot's name in it."""
        return self.key.replace("{robot}", robot)

    @property
    def sense(self) -> str:
        """The name of the sense that the route carries, if it carries one; else the route's own name."""
        return self.of or self.name

    @property
    def lifetime(self) -> float | None:
        """The lifetime of a message [s]; None if it is unlimited."""
        return DEFAULT_COMMAND_TTL if self.ttl is None and self.carried in (Carried.COMMAND, Carried.STOP) else self.ttl

    @property
    def rate(self) -> float:
        """The maximum rate of accepted messages [1/s]; 0 for no limit, as for a journal, of which none may be lost."""
        if self.carried is Carried.JOURNAL:
            return 0.0
        usual = STOP_RATE if self.carried is Carried.STOP else USUAL_RATE
        return self.most or (usual if self.direction is Direction.IN else MAX_RATE)
