"""The places of a hall that the robot can be sent to by name."""

from collections.abc import Mapping
from dataclasses import dataclass, field

DEFAULT_WITHIN = 0.25
"""How near a robot must be to count as being at a place, if the place does not say [m]."""


@dataclass(frozen=True, slots=True)
class HallPlace:
    """A place where the robot can stand, in the frame of the stage: x forward, y to the left of where it starts [m].

    `heading` is how far it turns to the left there [rad], None where it may look anywhere. It is there where it is no
    farther than `within` [m] from it, as far as it can tell.
    """

    x: float
    y: float
    heading: float | None = None
    within: float = DEFAULT_WITHIN


@dataclass(frozen=True, slots=True)
class HallPlaces:
    """The places of the hall that the robot can go to, by name."""

    by_name: Mapping[str, HallPlace] = field(default_factory=dict)
