"""The messages that the exhibition uses, and how each is carried."""

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
    """Return the routes whose names have a meaning for Lumen, and what each is for; all others are the exhibition's."""
    return {**{sense: str(row.meaning) for sense, row in table("senses").items()}, **_MEANINGS}


JSON_TYPE, JPEG_TYPE, FLOATS_TYPE = "application/json", "image/jpeg", "application/vnd.lumen.float32"
"""In which forms a body may cross a broker: as JSON, an image as it is, joints as numbers of 32 bits."""


class Direction(StrEnum):
    """`in`: a module publishes and Lumen listens; `out`: Lumen publishes and modules listen."""

    IN = "in"
    OUT = "out"


class Carried(StrEnum):
    """As what a message travels, which decides what becomes of it when the way is slow, full or cut.

    `telemetry` says how things are: the newest wins. A `command` is done soon or not at all. A `stop` is a command that
    waits behind nothing. Of a `journal` nothing is lost.
    """

    TELEMETRY = "telemetry"
    COMMAND = "command"
    STOP = "stop"
    JOURNAL = "journal"


DEFAULT_COMMAND_TTL = 5.0
"""How long a command may wait if its route does not say [s]."""
LONGEST_COMMAND_TTL = 10.0
"""How long a command should wait at most [s]: later, the people around the robot have moved."""


MAX_RATE = 2_000.0
"""How many messages are accepted of a route without a limit [1/s]; a fault in a loop sends thousands."""
USUAL_RATE = 50.0
"""How many are accepted of an incoming route that does not say [1/s]: as many as the exhibition has ticks."""


STOP_RATE = 200.0
"""How many stops are accepted if their route does not say [1/s]; none may be lost among others."""


class Size(NamedTuple):
    """Of a picture [px]."""

    width: int
    height: int

    def __str__(self) -> str:
        return f"{self.width} x {self.height}"


SIZES = tuple(Size(320 * n // 2, 240 * n // 2) for n in (1, 2, 4, 8))
"""What NAO's cameras give: NAOqi's kQQVGA to k4VGA."""

SHORTEST_IMAGE_INTERVAL = 0.033
"""The time between two images of NAO's cameras [s]: 30 a second."""


class RouteUse(NamedTuple):
    """The first place in a behaviour that uses a route."""

    file: str
    where: NodePath
    verb: Literal["hears", "publishes to"]


@dataclass(frozen=True, slots=True)
class Route:
    """A row of the route table in `lumen.yaml`.

    `of` names the sense that it carries besides the route of that name, for who wants it at another pace, in another
    size, or as another `content_type`, which is its form on a broker. `key` may hold `{robot}`; `alias` is what it is
    called besides while one robot is on the bus: what goes out goes out under both, what comes in may come under
    either. `schema` names a file of `schemas/messages/`. `event` is the event that a message becomes for the behaviour.
    `every` [s] is the period of a sense, `size` that of its images, None for the camera's own; `ttl` [s] the time to
    live, `keep` how many messages wait at most, `most` how many are taken a second, `latency` [s] how old a body
    without a `time` is taken to be. `must_arrive`: who sends it keeps it until the broker has it, who takes it gives it
    back unless it was handled.
    """

    name: str
    key: str
    direction: Direction
    schema: str = ""
    event: str = ""
    every: float | None = None
    size: Size | None = None
    ttl: float | None = None
    keep: int | None = None
    carried: Carried = Carried.TELEMETRY
    must_arrive: bool = False
    latency: float = 0.15
    most: float | None = None
    alias: str = ""
    of: str = ""
    content_type: str = JSON_TYPE
    where: NodePath = field(default=(), compare=False)
    built_in: bool = field(default=False, compare=False)
    uses: tuple[RouteUse, ...] = field(default=(), compare=False)

    def key_for(self, robot: str) -> str:
        """Return the routing key with the robot's name in it."""
        return self.key.replace("{robot}", robot)

    @property
    def sense(self) -> str:
        """The sense that the route carries, if it carries one."""
        return self.of or self.name

    @property
    def lifetime(self) -> float | None:
        """How long a message may wait [s]; None if it does not matter."""
        return DEFAULT_COMMAND_TTL if self.ttl is None and self.carried in (Carried.COMMAND, Carried.STOP) else self.ttl

    @property
    def rate(self) -> float:
        """How many messages are accepted [1/s]; 0 for all of them, as for a journal, of which none may be lost."""
        if self.carried is Carried.JOURNAL:
            return 0.0
        usual = STOP_RATE if self.carried is Carried.STOP else USUAL_RATE
        return self.most or (usual if self.direction is Direction.IN else MAX_RATE)
