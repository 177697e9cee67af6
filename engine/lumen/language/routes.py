"""Which messages the exhibition knows, and how each is carried."""

from dataclasses import dataclass, field
from enum import StrEnum

from lumen.language.diagnostics import Path


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
