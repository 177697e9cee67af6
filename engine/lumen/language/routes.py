"""Which messages the exhibition knows, and how each is carried."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum

from lumen.language.diagnostics import Path

IMAGE, JOINT, SONAR, TACTILE, BATTERY = "image", "joint", "sonar", "tactile", "battery"
FACE, HEARD, COMMAND = "face", "heard", "command"

MEANINGS: Mapping[str, str] = {
    IMAGE: "what the robot's camera sees",
    JOINT: "where its joints stand; `track` follows nothing without it",
    SONAR: "how far away the nearest echoes are",
    TACTILE: "which of its sensors are pressed",
    BATTERY: "how full its battery is",
    FACE: "where a visitor's face stands in the camera's image; simulated visitors are seen on it",
    HEARD: "what a visitor said; what is typed, and what a story's visitor says, comes on it",
    COMMAND: "what other modules ask of the robot",
}
"""The routes whose names mean something to Lumen itself, and what each is for; all others are the exhibition's own."""


class Direction(StrEnum):
    """`in`: a module publishes and Lumen listens; `out`: Lumen publishes and modules listen."""

    IN = "in"
    OUT = "out"


@dataclass(frozen=True, slots=True)
class Route:
    """A row of the route table in `lumen.yaml`.

    `key` may hold `{robot}`. `schema` names a file of `schemas/messages/`. `event` is the event that a message
    becomes for the behaviour. `every` [s] is the period of a sense, `ttl` [s] the time to live, `keep` how many
    messages wait at most, `latency` [s] how old a body without a `time` is taken to be.
    """

    name: str
    key: str
    direction: Direction
    schema: str = ""
    event: str = ""
    every: float | None = None
    ttl: float | None = None
    keep: int | None = None
    must_arrive: bool = False
    latency: float = 0.15
    where: Path = field(default=(), compare=False)

    def key_for(self, robot: str) -> str:
        """The routing key with the robot's name in it."""
        return self.key.replace("{robot}", robot)
