"""The state of a robot's agent on disk, from which the agent continues after a crash."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

from lumen.features.fleet.rollouts.orders import FollowedOrder
from lumen.project.home import Home

MAX_KEPT = 6
"""The maximum number of remembered bundle names."""


@dataclass
class AgentMemory:
    """The persistent state of a robot's agent."""

    followed: FollowedOrder = field(default_factory=FollowedOrder)
    """The last accepted order."""
    names: dict[str, str] = field(default_factory=dict)
    """Each bundle's hash in the fleet, by the hash of its files as adapted to this house."""
    before: str = ""
    """The hash of the files that ran before the present files."""
    failed: dict[str, list[Any]] = field(default_factory=dict)
    """For each failed bundle: the order's term and version, the robot's state, and the reason."""
    done: list[int] = field(default_factory=list)
    """The term and version of the last fulfilled order; empty if no order was fulfilled."""
    trying: str = ""
    """The bundle on probation; empty for none."""
    tries: int = 0
    """The number of restarts of the exhibition's process during that probation."""
    writing: str = ""
    """The hash of files that are being written into the project's folder; empty for none."""
    now: dict[str, float] = field(default_factory=dict)
    """Counts by measure since the present files began to run."""
    past: dict[str, float] = field(default_factory=dict)
    """Counts by measure for the files that ran before."""
    counted: str = ""
    """The hash of the files to which `now` applies."""
    since: float = 0.0
    """The time at which the files `counted` began to run [s since 1970]."""

    def name(self, files: str, bundle: str) -> None:
        """Remember that the files with the hash `files` are this bundle, as adapted to this house."""
        self.names.pop(files, None)
        self.names[files] = bundle
        for old in list(self.names)[:-MAX_KEPT]:
            del self.names[old]

    @property
    def order(self) -> list[int]:
        """The term and version of the last accepted order."""
        return [self.followed.term, self.followed.version]


def memory_file(robot: str) -> str:
    """Return the name of the file with an agent's memory, in the home of its project."""
    return f"fleet-{robot}.json"


def remember(home: Home, robot: str) -> AgentMemory:
    """Return the memory of the robot's agent saved in `home`; an empty memory if the file is missing or invalid."""
    data = home.read_json(memory_file(robot))
    if not isinstance(data, Mapping):
        return AgentMemory()
    try:
        return AgentMemory(**{**data, "followed": FollowedOrder(**data["followed"])})
    except (KeyError, TypeError):
        return AgentMemory()


def keep(home: Home, robot: str, memory: AgentMemory) -> str:
    """Save the memory of the robot's agent in `home`; return an error message if that failed, else an empty string."""
    return home.write_json(memory_file(robot), asdict(memory))
