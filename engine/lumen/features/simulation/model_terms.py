"""What the simulation calls the robot and its place in the hall, and how one robot differs from the next."""

from dataclasses import dataclass

ROBOT_PREFIX = "nao"
"""What the names of the robot's elements begin with in the hall: `nao/` and its own name."""

STAGE_SITE = "stage"
"""The site of the hall where the robot stands."""

PLAY_SUFFIX = "Play"
"""What the name of a joint's play in its gears ends with: `LKneePitchPlay`."""


@dataclass(frozen=True, slots=True)
class Variation:
    """How this robot and its hall differ from the model: factors of all masses and of the ground's friction."""

    mass: float = 1.0
    friction: float = 1.0
