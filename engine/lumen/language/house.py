"""The robots that perform in a house, each with what differs from the common settings in lumen.yaml."""

from dataclasses import dataclass

DEFAULT_SPACING = 0.6
"""The distance between robots in a row, if lumen.yaml does not place them [m]."""


@dataclass(frozen=True, slots=True)
class StartPose:
    """The pose of a robot in the hall at its start."""

    x: float = 0.0
    """The x coordinate in the hall [m]."""
    y: float = 0.0
    """The y coordinate in the hall [m]."""
    facing: float = 0.0
    """The turn to the left [rad]."""


@dataclass(frozen=True, slots=True)
class RobotSpec:
    """A robot of `robots:`, or the one of `robot:`, with its own settings or the common ones."""

    name: str
    """The robot's name, which replaces {robot} in routing keys."""
    model: str = ""
    """The name of the robot's body."""
    at: StartPose = StartPose()
    """The robot's start in the hall."""
    behavior: str = ""
    """The behaviour that the robot runs."""
    languages: tuple[str, ...] = ()
    """The languages that the robot speaks."""
    story: str = ""
    """The story that the robot is shown with by default."""
    stand: str = ""
    """The robot's stand, which replaces {stand} in routing keys."""
    driver: str = ""
    """The project's own driver of the robot, `package:Class` or a name in drivers/; empty for none."""
