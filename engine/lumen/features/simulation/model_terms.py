"""Names of the robot's elements and its place in the hall's model, and the variations between robots."""

from dataclasses import dataclass

ROBOT_PREFIX = "nao"
"""The prefix of the robot's elements in the hall: `nao/` and their own names."""

STAGE_SITE = "stage"
"""The site of the hall that the robot is placed on."""

PLAY_SUFFIX = "Play"
"""The suffix of the joint that models a joint's play: `LKneePitchPlay`."""


@dataclass(frozen=True, slots=True)
class Variation:
    """A robot and hall that differ from the model."""

    mass: float = 1.0
    """The factor of all masses."""
    friction: float = 1.0
    """The factor of the ground's friction."""
