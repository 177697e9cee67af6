"""The places of a hall that the robot can be sent to by name."""

from collections.abc import Mapping
from dataclasses import dataclass, field

DEFAULT_WITHIN = 0.25
"""The distance within which a robot counts as being at a place that sets none [m]."""


@dataclass(frozen=True, slots=True)
class HallPlace:
    """A place for the robot to stand, in the frame of the stage."""

    x: float
    """The distance ahead of the robot's start [m]."""
    y: float
    """The distance to the left of the robot's start [m]."""
    heading: float | None = None
    """The heading to take there, to the left of the one at the start [rad]; None for any."""
    within: float = DEFAULT_WITHIN
    """The distance within which the robot counts as being there, by its own estimate [m]."""


@dataclass(frozen=True, slots=True)
class HallPlaces:
    """The places of the hall that the robot can go to, by name."""

    by_name: Mapping[str, HallPlace] = field(default_factory=dict)
