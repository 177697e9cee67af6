"""The robots that perform in a house, each with what differs from the common settings in lumen.yaml."""

from dataclasses import dataclass

DEFAULT_SPACING = 0.6
"""The distance between robots in a row, if lumen.yaml does not place them [m]."""


@dataclass(frozen=True, slots=True)
class StartPose:
    """The pose of a robot in the hall at its start: `x`, `y` [m], and how far to the left it faces [rad]."""

    x: float = 0.0
    y: float = 0.0
    facing: float = 0.0


@dataclass(frozen=True, slots=True)
class RobotSpec:
    """A robot of `robots:`, or the one of `robot:`: what counts for it, its own or that of all.

    `name` stands for {robot} in routing keys, `stand` for {stand}; `model` is its body, `at` where it stands in the
    hall; `behavior`, `languages` and `story` are what it does, speaks, and is tried with. `driver` is the robot of the
    project's own that performs it, `package:Class` or a name in drivers/, empty for none.
    """

    name: str
    model: str = ""
    at: StartPose = StartPose()
    behavior: str = ""
    languages: tuple[str, ...] = ()
    story: str = ""
    stand: str = ""
    driver: str = ""
