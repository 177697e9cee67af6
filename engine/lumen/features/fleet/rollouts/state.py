"""Where a centre and its rollout stand, as values that a journal can keep."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, replace
from typing import Any

from lumen.features.fleet.rollouts.presence import RobotPresence
from lumen.features.fleet.settings import RolloutPlan, StepTarget

GOING, PAUSED, PERSON, ABORTED, FINISHED = "going", "paused", "a person decides", "aborted", "finished"
UNDER_WAY = (GOING, PAUSED, PERSON)


@dataclass(frozen=True, slots=True)
class Rollout:
    """A bundle on its way: at step `at` of its plan, wanted of the `assigned` robots, which only become more.

    `watched` is for how long most of them have run it [s], `waited` for how long this step has been under way, both
    counted while the centre lived. `reason` says why it stands as it does. `prior` is what was wanted of the assigned
    before, `version` that of the orders before it. `tried` is whether the robots were waited for that try it first.
    """

    bundle: str
    plan: RolloutPlan
    at: int = 0
    assigned: tuple[str, ...] = ()
    watched: float = 0.0
    waited: float = 0.0
    state: str = GOING
    reason: str = ""
    begun: float = 0.0
    version: int = 0
    prior: Mapping[str, str] = field(default_factory=dict)
    tried: bool = False

    @property
    def under_way(self) -> bool:
        return self.state in UNDER_WAY


@dataclass(frozen=True, slots=True)
class CentreState:
    """What a centre knows and wants.

    `wanted` is what each robot is to run (a hash, or `!HASH`), by HOUSE/ROBOT. `exposed` are the robots that may run a
    bundle that is not proved, with the bundle and the version that took it back, 0 while none did. `proved` are bundles
    whose rollout was finished. `pinned` robots take part in none; `looked` is when it was looked last [s]. `trying` is
    the bundle that all are to try.
    """

    centre: str
    term: int = 1
    version: int = 0
    wanted: Mapping[str, str] = field(default_factory=dict)
    exposed: Mapping[str, tuple[str, int]] = field(default_factory=dict)
    proved: tuple[str, ...] = ()
    pinned: tuple[str, ...] = ()
    rollout: Rollout | None = None
    looked: float = 0.0
    overruled: str = ""
    trying: str = ""

    def attempt(self, bundle: str) -> "CentreState":
        """With a bundle that all robots try and do not take, or (empty) none any more: another version."""
        return self if bundle == self.trying else replace(self, trying=bundle, version=self.version + 1)

    def want(self, wanted: Mapping[str, str]) -> "CentreState":
        """With something else wanted of some robots: another version."""
        if wanted.items() <= self.wanted.items():
            return self
        return replace(self, wanted={**self.wanted, **wanted}, version=self.version + 1)


@dataclass(frozen=True, slots=True)
class HeardPresence:
    """A presence, and when the centre heard it by its own clock [s]."""

    presence: RobotPresence
    at: float


def state_to_json(state: CentreState) -> dict[str, Any]:
    return asdict(state)


def state_from_json(data: Mapping[str, Any]) -> CentreState:
    """The state that was written. Raises KeyError, TypeError or ValueError where it is none."""
    row = dict(data)
    row["proved"], row["pinned"] = tuple(row["proved"]), tuple(row["pinned"])
    row["exposed"] = {robot: (str(bundle), int(version)) for robot, (bundle, version) in row["exposed"].items()}
    if rollout := row["rollout"]:
        plan = rollout["plan"]
        steps = tuple(StepTarget(**step) for step in plan["steps"])
        rollout = {**rollout, "plan": RolloutPlan(**{**plan, "steps": steps}), "assigned": tuple(rollout["assigned"])}
        row["rollout"] = Rollout(**rollout)
    return CentreState(**row)
