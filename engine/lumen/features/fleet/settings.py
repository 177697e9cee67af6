"""A fleet: houses with their robots, groups of them, and how they get other files, step by step."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from lumen.language.diagnostics import NodePath

EVERYBODY = "all"
"""The step of a rollout that is every robot."""
DEFAULT_PAUSE = 1800.0
"""How long each step of a rollout is watched [s], where fleet.yaml does not say."""


@dataclass(frozen=True, slots=True)
class FleetHouse:
    """A house: the address of its broker, the names of its robots, and labels to choose it by."""

    broker: str
    robots: tuple[str, ...] = ()
    labels: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class FleetGroup:
    """Robots by name (`HOUSE/ROBOT`), those of whole houses, and those of houses that have all these labels."""

    robots: tuple[str, ...] = ()
    houses: tuple[str, ...] = ()
    labels: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class FleetMeasure:
    """What is counted at each robot: an event by its name, or how often a state is entered (`*` for any part of one).

    It is told for each hour, or for each time that the measure `per` has counted.
    """

    event: str = ""
    enters: str = ""
    per: str = ""


@dataclass(frozen=True, slots=True)
class StepTarget:
    """Who is to have the bundle once a step is taken: a group, or a `share` of all robots (0 to 1)."""

    group: str = ""
    share: float = 0.0

    def __str__(self) -> str:
        return self.group or (EVERYBODY if self.share == 1.0 else f"{100.0 * self.share:g}%")


@dataclass(frozen=True, slots=True)
class RolloutPlan:
    """Its steps, how long each is watched [s], and what sends all back; `abort_if` is empty where nothing does.

    With `try_first` all robots try the bundle before the first one takes it.
    """

    steps: tuple[StepTarget, ...] = (StepTarget(share=1.0),)
    pause: float = DEFAULT_PAUSE
    abort_if: str = ""
    try_first: bool = False


@dataclass(frozen=True, slots=True)
class Fleet:
    """What fleet.yaml says; `key` is the public key that bundles and orders are checked with, in base64."""

    centre: str = ""
    key: str = ""
    houses: Mapping[str, FleetHouse] = field(default_factory=dict)
    groups: Mapping[str, FleetGroup] = field(default_factory=dict)
    measures: Mapping[str, FleetMeasure] = field(default_factory=dict)
    rollout: RolloutPlan = field(default_factory=RolloutPlan)
    where: NodePath = ()

    @property
    def robots(self) -> tuple[str, ...]:
        """All robots, as `HOUSE/ROBOT`, in the order written."""
        return tuple(f"{name}/{robot}" for name, house in self.houses.items() for robot in house.robots)

    def members(self, target: StepTarget) -> tuple[str, ...]:
        """The robots that a step may be taken at: those of its group, or all of them."""
        group = self.groups.get(target.group)
        if group is None:
            return self.robots
        chosen = {*group.robots}
        for name, house in self.houses.items():
            labelled = bool(group.labels) and group.labels.items() <= house.labels.items()
            if name in group.houses or labelled:
                chosen |= {f"{name}/{robot}" for robot in house.robots}
        return tuple(robot for robot in self.robots if robot in chosen)


def step_target(text: str) -> StepTarget | None:
    """What `demo-1`, `10%` or `all` means; None for a share that is none (more than all, or nothing)."""
    if text == EVERYBODY:
        return StepTarget(share=1.0)
    if not text.endswith("%"):
        return StepTarget(group=text)
    try:
        share = float(text[:-1]) / 100.0
    except ValueError:
        return None
    return StepTarget(share=share) if 0.0 < share <= 1.0 else None
