"""The robot in its hall, as one dm_control model."""

from dataclasses import dataclass
from pathlib import Path

from dm_control import mjcf

from lumen.errors import RobotError
from lumen.language.robots import Body

ROBOT = "nao"
"""What the names of the robot's elements begin with in the hall: `nao/HeadYaw`."""

STAGE = "stage"
"""The site of the hall where the robot stands."""


@dataclass(frozen=True, slots=True)
class Variation:
    """How this robot and its hall differ from the model: factors of all masses and of the ground's friction."""

    mass: float = 1.0
    friction: float = 1.0


def load(body: Body, models: Path, hall: str, variation: Variation | None = None) -> mjcf.RootElement:
    """The hall with the robot on its stage, free to fall; raises RobotError where a file is no such model."""
    robot, world = _read(models / body.mjcf), _read(models / hall)
    known = {joint.name for joint in robot.find_all("joint")}
    if lost := [name for name in body.joints if name not in known]:
        raise RobotError(f"{body.mjcf} lacks the joints {', '.join(lost)}, which the body's description names")
    stage = world.find("site", STAGE)
    if stage is None:
        raise RobotError(f"{hall} has no site `{STAGE}` for the robot to stand on")
    robot.model = ROBOT
    stage.attach(robot).add("freejoint")
    if variation:
        _vary(world, variation)
    return world


def _read(path: Path) -> mjcf.RootElement:
    if not path.is_file():
        raise RobotError(f"there is no model {path.name} in {path.parent.name}/")
    try:
        return mjcf.from_path(str(path))
    except Exception as error:  # the parser raises whatever it stumbles over
        reason = " ".join(str(error).split())
        raise RobotError(f"{path.name} is not MJCF: {reason}") from error


def _vary(world: mjcf.RootElement, variation: Variation) -> None:
    for body in world.find_all("body"):
        if body.inertial is not None:
            inertial = body.inertial
            inertial.mass *= variation.mass
            if inertial.fullinertia is not None:
                inertial.fullinertia = inertial.fullinertia * variation.mass
    for geom in world.find_all("geom"):
        if geom.friction is not None:
            geom.friction = geom.friction * variation.friction
    for default in world.find_all("default"):
        if default.geom is not None and default.geom.friction is not None:
            default.geom.friction = default.geom.friction * variation.friction
