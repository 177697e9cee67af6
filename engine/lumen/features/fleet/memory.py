"""The state of a robot's agent on its disk, from which it continues after a crash."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

from lumen.features.fleet.rollouts.orders import FollowedOrder
from lumen.project.home import Home

MAX_KEPT = 6
"""The most bundles whose names in the fleet are remembered."""


@dataclass
class AgentMemory:
    """The persistent state of a robot's agent."""

    followed: FollowedOrder = field(default_factory=FollowedOrder)
    """The last accepted order."""
    names: dict[str, str] = field(default_factory=dict)
    """The fleet's name of each bundle, by the hash of its files as adapted to this house."""
    before: str = ""
    """The hash of the files that ran before the present ones."""
    failed: dict[str, list[Any]] = field(default_factory=dict)
    """For each failed bundle: the order's term and version, the robot's state, and the reason."""
    done: list[int] = field(default_factory=list)
    """The term and version of the last order that was fulfilled; empty if none was."""
    trying: str = ""
    """The bundle that is on probation; empty if none is."""
    tries: int = 0
    """The number of times that the exhibition's process began again during that probation."""
    writing: str = ""
    """The hash of files that are being written into the project's folder."""
    now: dict[str, float] = field(default_factory=dict)
    """Counts since the present files began to run."""
    past: dict[str, float] = field(default_factory=dict)
    """Counts of the files that ran before the present ones."""
    counted: str = ""
    """The hash of the files that `now` counts for."""
    since: float = 0.0
    """The time at which these files began to run [s since 1970]."""

    def name(self, files: str, bundle: str) -> None:
        """Remember that files of that hash are this bundle, as adapted to this house."""
        self.names.pop(files, None)
        self.names[files] = bundle
        for old in list(self.names)[:-MAX_KEPT]:
            del self.names[old]

    @property
    def order(self) -> list[int]:
        """The term and version of the order that is followed."""
        return [self.followed.term, self.followed.version]


def memory_file(robot: str) -> str:
    """Return the name of a robot agent's file in the home of its project."""
    return f"fleet-{robot}.json"


def remember(home: Home, robot: str) -> AgentMemory:
    """Return the kept state; an empty one if there is none or it is unreadable."""
    data = home.read_json(memory_file(robot))
    if not isinstance(data, Mapping):
        return AgentMemory()
    try:
        row = {**data, "followed": FollowedOrder(**data["followed"])}
        return AgentMemory(**row)
    except (KeyError, TypeError):
        return AgentMemory()


def keep(home: Home, robot: str, memory: AgentMemory) -> str:
    """Write the state to the robot's home; return the error, else an empty text."""
    return home.write_json(memory_file(robot), asdict(memory))
