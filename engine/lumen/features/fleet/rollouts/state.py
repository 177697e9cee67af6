"""The state of a centre and its rollout, which can be saved in a journal."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, replace
from typing import Any

from lumen.features.fleet.rollouts.presence import RobotPresence
from lumen.features.fleet.settings import RolloutPlan, StepTarget

GOING, PAUSED, PERSON, ABORTED, FINISHED = "going", "paused", "a person decides", "aborted", "finished"
UNDER_WAY = (GOING, PAUSED, PERSON)


@dataclass(frozen=True, slots=True)
class Rollout:
    """A bundle that is being rolled out."""

    bundle: str
    """The bundle's hash."""
    plan: RolloutPlan
    at: int = 0
    """The index of the present step."""
    assigned: tuple[str, ...] = ()
    """The robots with the bundle; their number only grows."""
    watched: float = 0.0
    """The time in this step for which the centre ran and most assigned robots had proved the bundle [s]."""
    waited: float = 0.0
    """The time for which this step has been under way while the centre ran [s]."""
    state: str = GOING
    reason: str = ""
    """The reason for `state`, which may be empty."""
    begun: float = 0.0
    """The rollout's start [s since 1970]."""
    version: int = 0
    """The version of the last order before the rollout or, after trials, before its first step."""
    prior: Mapping[str, str] = field(default_factory=dict)
    """Each assigned robot's proved bundle from before the rollout; robots without a proved bundle are left out."""
    tried: bool = False
    """Whether the trials before the first step have ended."""

    @property
    def under_way(self) -> bool:
        """Whether the rollout is neither aborted nor finished."""
        return self.state in UNDER_WAY


@dataclass(frozen=True, slots=True)
class CentreState:
    """A centre's state, which its journal stores."""

    centre: str
    """The centre's id."""
    term: int = 1
    """The number of the centre's term, which grows when a centre takes over from another."""
    version: int = 0
    """The number of the last order in this term."""
    wanted: Mapping[str, str] = field(default_factory=dict)
    """The bundle that each robot should run (a hash, or `!HASH`), by HOUSE/ROBOT."""
    exposed: Mapping[str, tuple[str, int]] = field(default_factory=dict)
    """For each robot, the unproved bundle that it may run, and the version of the withdrawing order, 0 for none."""
    proved: tuple[str, ...] = ()
    """The bundles with a finished rollout."""
    pinned: tuple[str, ...] = ()
    """The robots that rollouts leave out."""
    rollout: Rollout | None = None
    looked: float = 0.0
    """The time of the last tick [s since 1970]."""
    overruled: str = ""
    """The reason why this centre no longer gives orders; empty if it gives orders."""
    trying: str = ""
    """The bundle that all robots should try; empty for none."""

    def attempt(self, bundle: str) -> "CentreState":
        """Return the state with the bundle that all robots should try, empty for none; a change increases `version`."""
        return self if bundle == self.trying else replace(self, trying=bundle, version=self.version + 1)

    def want(self, wanted: Mapping[str, str]) -> "CentreState":
        """Return the state with these wanted bundles by robot; a change increases `version`."""
        if wanted.items() <= self.wanted.items():
            return self
        return replace(self, wanted={**self.wanted, **wanted}, version=self.version + 1)


@dataclass(frozen=True, slots=True)
class HeardPresence:
    """A presence, and the centre's time at its arrival [s since 1970]."""

    presence: RobotPresence
    at: float


def state_to_json(state: CentreState) -> dict[str, Any]:
    """Return the state as JSON data."""
    return asdict(state)


def state_from_json(data: Mapping[str, Any]) -> CentreState:
    """Return the state from its JSON data. Raises KeyError, TypeError or ValueError if the data is invalid."""
    row = dict(data)
    row["proved"], row["pinned"] = tuple(row["proved"]), tuple(row["pinned"])
    row["exposed"] = {robot: (str(bundle), int(version)) for robot, (bundle, version) in row["exposed"].items()}
    if rollout := row["rollout"]:
        plan = rollout["plan"]
        steps = tuple(StepTarget(**step) for step in plan["steps"])
        rollout = {**rollout, "plan": RolloutPlan(**{**plan, "steps": steps}), "assigned": tuple(rollout["assigned"])}
        row["rollout"] = Rollout(**rollout)
    return CentreState(**row)
