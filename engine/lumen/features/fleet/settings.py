"""A fleet: houses with their robots, groups of them, and the plan for updating them step by step."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from lumen.language.diagnostics import NodePath

EVERYBODY = "all"
"""The target of a rollout's step that means every robot."""
DEFAULT_PAUSE = 1800.0
"""The default time to watch each step of a rollout [s]."""


@dataclass(frozen=True, slots=True)
class FleetHouse:
    """A house with its robots."""

    broker: str
    """The address of the house's broker."""
    robots: tuple[str, ...] = ()
    """The names of the house's robots."""
    labels: Mapping[str, str] = field(default_factory=dict)
    """Labels by which groups choose the house."""


@dataclass(frozen=True, slots=True)
class FleetGroup:
    """A group: the union of robots, houses and labelled houses."""

    robots: tuple[str, ...] = ()
    """Robots by name (`HOUSE/ROBOT`)."""
    houses: tuple[str, ...] = ()
    """Houses whose robots all belong to the group."""
    labels: Mapping[str, str] = field(default_factory=dict)
    """Labels: all robots of houses that have all of these belong to the group; none if it is empty."""


@dataclass(frozen=True, slots=True)
class FleetMeasure:
    """A count at each robot, reported per hour or per count of another measure."""

    event: str = ""
    """The name of the events to count (`*` for any part of it)."""
    enters: str = ""
    """The state whose entries to count (`*` for any part of it)."""
    per: str = ""
    """The measure to divide by; empty for hours."""


@dataclass(frozen=True, slots=True)
class StepTarget:
    """The robots that have the bundle after a step: those of a group, or a share of all robots."""

    group: str = ""
    """The name of the group, empty for a share."""
    share: float = 0.0
    """The share of all robots, from 0 to 1."""

    def __str__(self) -> str:
        return self.group or (EVERYBODY if self.share == 1.0 else f"{100.0 * self.share:g}%")


@dataclass(frozen=True, slots=True)
class RolloutPlan:
    """The steps of a rollout and the conditions of going on to the next."""

    steps: tuple[StepTarget, ...] = (StepTarget(share=1.0),)
    pause: float = DEFAULT_PAUSE
    """The time for which each step is watched [s]."""
    abort_if: str = ""
    """The condition that rolls all robots back, empty for none."""
    try_first: bool = False
    """True if all robots try the bundle before the first one switches to it."""


@dataclass(frozen=True, slots=True)
class Fleet:
    """The content of fleet.yaml."""

    centre: str = ""
    """The address of the centre's broker."""
    key: str = ""
    """The public key, in base64, with which robots check bundles and orders."""
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
        """Return the robots that a step may choose from: those of its group, or all."""
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
    """Return the target that `demo-1`, `10%` or `all` means; None for a share that is not in (0 %, 100 %]."""
    if text == EVERYBODY:
        return StepTarget(share=1.0)
    if not text.endswith("%"):
        return StepTarget(group=text)
    try:
        share = float(text[:-1]) / 100.0
    except ValueError:
        return None
    return StepTarget(share=share) if 0.0 < share <= 1.0 else None
