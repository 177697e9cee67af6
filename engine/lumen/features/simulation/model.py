"""The robot in its hall, as one dm_control model."""

import re
from math import degrees, inf
from pathlib import Path

from lumen.errors import RobotModelError
from lumen.features.simulation.imperfections import BACKLASH
from lumen.features.simulation.model_terms import PLAY_SUFFIX, ROBOT_PREFIX, STAGE_SITE, Variation
from lumen.features.simulation.physics import mjcf, mujoco
from lumen.features.simulation.requirements import lacks_of_body, lacks_of_hall, lacks_of_robot
from lumen.language.robots import Body
from lumen.project.packaged_models import mjcf_path

_GEAR_INERTIA, _GEAR_DAMPING = 0.01, 0.01
"""Of the gears' last wheel [kg m^2], [N m s/rad]; chosen: with less the robot rattles where it rests."""

_STIFFNESS, _HARDNESS = (0.005, 1.0), (0.99, 0.999, 0.001)
"""How hard teeth meet: `solreflimit`, `solimplimit`."""


def loosen(robot: mjcf.RootElement, body: Body) -> None:
    """Give each joint that turns a second one behind it, which no motor turns, free within the gear's play.

    The first one is the motor's: its servo, friction and inertia end there. The link hangs behind the second.
    """
    for name in body.joints:
        if name not in (*body.hands, *body.slides):
            motor = robot.find("joint", name)
            motor.parent.add(
                "joint",
                name=name + PLAY_SUFFIX,
                dclass=motor.dclass,
                type=motor.type,
                pos=motor.pos,
                axis=motor.axis,
                limited=True,
                range=(-BACKLASH / 2, BACKLASH / 2),
                armature=_GEAR_INERTIA,
                damping=_GEAR_DAMPING,
                frictionloss=0.0,
                solreflimit=_STIFFNESS,
                solimplimit=_HARDNESS,
            )


def add_servos(robot: mjcf.RootElement, body: Body) -> None:
    """Give joints without a servo of their name one, in place of other motors that drive them.

    It gives all the joint's `effort` where it is `body.give` [rad] off, and is damped critically (MuJoCo's `dampratio`,
    from the masses in the zero posture). A joint that the model lacks, or whose effort nobody says, gets none.
    """
    if not body.give:
        return
    driving: dict[str, list[mjcf.Element]] = {}
    for motor in robot.find_all("actuator"):
        if getattr(motor, "joint", None) is not None:
            driving.setdefault(motor.joint.name, []).append(motor)
    for name, joint in body.joints.items():
        element, motors = robot.find("joint", name), driving.get(name, [])
        if element is None or name in body.shared or joint.effort == inf or any(_serves(m, name) for m in motors):
            continue
        for motor in motors:
            motor.remove()
        robot.actuator.add(
            "position",
            name=name,
            joint=element,
            kp=joint.effort / body.give,
            dampratio=1,
            ctrlrange=(joint.minimum, joint.maximum),
            forcerange=(-joint.effort, joint.effort),
        )


def _serves(motor: mjcf.Element, name: str) -> bool:
    return bool(motor.tag == "position" and motor.name == name)


def load(
    body: Body, models: Path, hall: str, variation: Variation | None = None, *, backlash: bool = False
) -> mjcf.RootElement:
    """The hall with the robot on its stage; `hall` is in `models`, or an absolute path.

    The robot is free to fall, unless its base is fixed: then it is part of what it stands on.

    Raises RobotError where a file is no MJCF, or lacks what the simulation needs of it: all of that is listed.
    """
    world = read_hall(models, hall)
    place(world, hall, body, models, world.find("site", STAGE_SITE), backlash=backlash)
    if variation:
        _vary(world, variation)
    return world


def read_hall(models: Path, hall: str) -> mjcf.RootElement:
    """The hall without a robot; raises RobotError as `load` does."""
    world = _read(models / hall)
    _complain(hall, lacks_of_hall(world))
    return world


def place(
    world: mjcf.RootElement,
    hall: str,
    body: Body,
    models: Path,
    site: mjcf.Element,
    *,
    backlash: bool,
    prefix: str = ROBOT_PREFIX,
) -> None:
    """Put a robot into a world, where the site is; raises RobotError as `load` does."""
    robot = alone(body, models)
    robot.model = prefix
    if backlash:
        loosen(robot, body)
    try:
        frame = site.attach(robot)
        if body.roles.base.row.moves:
            frame.add("freejoint")
    except ValueError as error:
        reason = " ".join(str(error).split())
        raise RobotModelError(f"{Path(hall).name} does not fit the robot's {body.mjcf}: {reason}") from error


def alone(body: Body, models: Path) -> mjcf.RootElement:
    """The robot without a world and without a free joint, to be attached to one; raises RobotError as `load` does."""
    if not body.mjcf:
        raise RobotModelError(f"{body.name} has no MJCF: run it with --robot naoqi or --robot recording")
    _complain("the description of the robot's body", lacks_of_body(body))
    robot = _read(mjcf_path(body.mjcf, models))
    add_servos(robot, body)
    _complain(body.mjcf, lacks_of_robot(robot, body))
    robot.model = ROBOT_PREFIX
    _differ(robot, body)
    return robot


def compile_world(world: mjcf.RootElement) -> mujoco.MjModel:
    """The world as MuJoCo has it; raises RobotError where it can't be built."""
    try:
        return mjcf.Physics.from_mjcf_model(world).model.ptr
    except Exception as error:  # the compiler raises whatever it stumbles over
        raise RobotModelError(f"MuJoCo cannot build the robot in its hall: {_plain(error)}") from error


def _plain(error: Exception) -> str:
    """What the compiler says, without dm_control's advice, its names of files and the lines of its own XML."""
    reason = " ".join(str(error).split()).rpartition("Error: ")[2]
    return re.sub(r"-[0-9a-f]{40}(?=\.)|, id \d+, line \d+", "", reason)


def _complain(what: str, lacks: list[str]) -> None:
    if lacks:
        raise RobotModelError(f"{what} lacks what the simulation needs: {', '.join(lacks)}")


def _read(path: Path) -> mjcf.RootElement:
    if not path.is_file():
        raise RobotModelError(f"there is no model {path.name} in {path.parent.name}/")
    try:
        return mjcf.from_path(str(path))
    except Exception as error:  # the parser raises whatever it stumbles over
        reason = " ".join(str(error).split())
        raise RobotModelError(f"{path.name} is not MJCF: {reason}") from error


def _differ(robot: mjcf.RootElement, body: Body) -> None:
    """Give the robot the links and the camera of this body: several are written in one MJCF."""
    for name, link in body.links.items():
        inertial = robot.find("body", name).inertial
        inertial.mass, inertial.pos, inertial.fullinertia = link.mass, link.centre, link.inertia
    if body.camera:
        for camera in robot.find_all("camera"):
            camera.fovy = degrees(body.camera.vertical_fov)


def _vary(world: mjcf.RootElement, variation: Variation) -> None:
    for body in world.find_all("body"):
        if body.inertial is not None:
            inertial = body.inertial
            inertial.mass *= variation.mass
            if inertial.fullinertia is not None:
                inertial.fullinertia = inertial.fullinertia * variation.mass
    for geom in world.find_all("geom"):
        of_class = geom.dclass.geom.mass if geom.dclass is not None and geom.dclass.geom is not None else None
        mass = of_class if geom.mass is None else geom.mass
        if mass is not None:
            geom.mass = mass * variation.mass
        if geom.friction is not None:
            geom.friction = geom.friction * variation.friction
    for default in world.find_all("default"):
        if default.geom is not None and default.geom.friction is not None:
            default.geom.friction = default.geom.friction * variation.friction
