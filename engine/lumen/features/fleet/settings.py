"""A fleet: houses with their robots, groups of robots, and the plan for updating robots step by step."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from lumen.language.diagnostics import NodePath

EVERYBODY = "all"
"""The target of a rollout step that includes every robot."""
DEFAULT_PAUSE = 1800.0
"""The default time for which each rollout step is watched [s]."""


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
    """Labels of houses: a house that has all these labels belongs to the group; no house if this is empty."""


@dataclass(frozen=True, slots=True)
class FleetMeasure:
    """A count at each robot, reported per hour or per count of another measure."""

    event: str = ""
    """The pattern of the names of events to count, with `*` for any text; empty for none."""
    enters: str = ""
    """The pattern of the names of states whose entries to count, with `*` for any text; empty for none."""
    per: str = ""
    """The measure to divide by; empty for hours."""


@dataclass(frozen=True, slots=True)
class StepTarget:
    """The robots that have the bundle after a step: a group, or a share of all robots."""

    group: str = ""
    """The group's name; empty for a share."""
    share: float = 0.0
    """The share of all robots, from 0 to 1; 0 for a group."""

    def __str__(self) -> str:
        return self.group or (EVERYBODY if self.share == 1.0 else f"{100.0 * self.share:g}%")


@dataclass(frozen=True, slots=True)
class RolloutPlan:
    """The steps of a rollout, and the conditions for the next step."""

    steps: tuple[StepTarget, ...] = (StepTarget(share=1.0),)
    pause: float = DEFAULT_PAUSE
    """The time for which each step is watched [s]."""
    abort_if: str = ""
    """The condition that rolls the robots of a rollout back; empty for none."""
    try_first: bool = False
    """Whether all robots try the bundle before the first robot switches to it."""


@dataclass(frozen=True, slots=True)
class Fleet:
    """The content of fleet.yaml."""

    centre: str = ""
    """The address of the centre's broker."""
    key: str = ""
    """The public key, in base64, with which robots verify bundles and orders; empty if missing."""
    houses: Mapping[str, FleetHouse] = field(default_factory=dict)
    groups: Mapping[str, FleetGroup] = field(default_factory=dict)
    measures: Mapping[str, FleetMeasure] = field(default_factory=dict)
    rollout: RolloutPlan = field(default_factory=RolloutPlan)
    where: NodePath = ()

    @property
    def robots(self) -> tuple[str, ...]:
        """All robots, as `HOUSE/ROBOT`, in the order of fleet.yaml."""
        return tuple(f"{name}/{robot}" for name, house in self.houses.items() for robot in house.robots)

    def members(self, target: StepTarget) -> tuple[str, ...]:
        """Return the robots that a step can choose: those of its group, or all if the fleet has no such group."""
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
    """Return the target for a group such as `demo-1`, a share such as `10%`, or `all`.

    Return None if a share is not a number in (0 %, 100 %].
    """
    if text == EVERYBODY:
        return StepTarget(share=1.0)
    if not text.endswith("%"):
        return StepTarget(group=text)
    try:
        share = float(text[:-1]) / 100.0
    except ValueError:
        return None
    return StepTarget(share=share) if 0.0 < share <= 1.0 else None
