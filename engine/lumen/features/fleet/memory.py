"""What a robot's agent keeps on its disk, so that a crash changes nothing of what it has promised."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

from lumen.features.fleet.rollouts.orders import FollowedOrder
from lumen.project.home import Home

MAX_KEPT = 6
"""Bundles of which it is remembered what they are called in the fleet."""


@dataclass
class AgentMemory:
    """`names` says which bundle of the fleet files are, by their hash in this house; `before` are the files that ran
    before those that run.

    `failed` is what became of a bundle at an order, `done` the order that was fulfilled last. `trying` is the bundle
    that is on probation, `tries` how often this process ended meanwhile. `writing` are files that are on their way into
    the project's folder. `counts` are those of `now` and `before`.
    """

    followed: FollowedOrder = field(default_factory=FollowedOrder)
    names: dict[str, str] = field(default_factory=dict)
    before: str = ""
    failed: dict[str, list[Any]] = field(default_factory=dict)
    done: list[int] = field(default_factory=list)
    trying: str = ""
    tries: int = 0
    writing: str = ""
    now: dict[str, float] = field(default_factory=dict)
    past: dict[str, float] = field(default_factory=dict)
    counted: str = ""
    since: float = 0.0

    def name(self, files: str, bundle: str) -> None:
        """Files of that hash are this bundle, or what runs here in its place."""
        self.names.pop(files, None)
        self.names[files] = bundle
        for old in list(self.names)[:-MAX_KEPT]:
            del self.names[old]

    @property
    def order(self) -> list[int]:
        """The order that is followed now."""
        return [self.followed.term, self.followed.version]


def memory_file(robot: str) -> str:
    """The file of a robot's agent in the home of its project."""
    return f"fleet-{robot}.json"


def remember(home: Home, robot: str) -> AgentMemory:
    """What was kept; nothing where there is nothing that can be read."""
    data = home.read_json(memory_file(robot))
    if not isinstance(data, Mapping):
        return AgentMemory()
    try:
        row = {**data, "followed": FollowedOrder(**data["followed"])}
        return AgentMemory(**row)
    except (KeyError, TypeError):
        return AgentMemory()


def keep(home: Home, robot: str, memory: AgentMemory) -> str:
    """Write it; why that could not be, else empty."""
    return home.write_json(memory_file(robot), asdict(memory))
