"""The robot in its hall, as one dm_control model."""

import re
from math import degrees, inf
from pathlib import Path

from lumen.errors import RobotModelError
from lumen.features.simulation.imperfections import BACKLASH
from lumen.features.simulation.model_terms import (
    PLAY_SUFFIX,
    ROBOT_PREFIX,
    STAGE_SITE,
    Variation,
    lacks_of_body,
    lacks_of_hall,
    lacks_of_robot,
)
from lumen.features.simulation.physics import mjcf, mujoco
from lumen.language.robots import Body
from lumen.project.packaged_models import mjcf_path

_GEAR_INERTIA, _GEAR_DAMPING = 0.01, 0.01
"""The armature [kg m^2] and damping [N m s/rad] of the joint that models a gear's play.

With smaller values, the robot rattles at rest.
"""

_STIFFNESS, _HARDNESS = (0.005, 1.0), (0.99, 0.999, 0.001)
"""The stiffness at both ends of the gears' play: MuJoCo's `solreflimit` and `solimplimit`."""


def loosen(robot: mjcf.RootElement, body: Body) -> None:
    """Add backlash: a second joint behind each turning joint, without a motor and free within the gear's play.

    The first joint keeps its servo, friction and inertia. The second joint moves the link.
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
    """Replace each joint's motors by a position servo with the joint's name, unless such a servo exists.

    A servo reaches the joint's full `effort` at an error of `body.give` [rad] and is critically damped (MuJoCo's
    `dampratio`, with the masses in the zero posture). Joints that the model lacks, that share another joint's motor or
    whose effort is unknown get no servo. If `body.give` is 0, nothing changes.
    """
    if not body.give:
        return
    driving: dict[str, list[mjcf.Element]] = {}
    for motor in robot.find_all("actuator"):
        if getattr(motor, "joint", None) is not None:
            driving.setdefault(motor.joint.name, []).append(motor)
    for name, joint in body.joints.items():
        element, motors = robot.find("joint", name), driving.get(name, [])
        if (
            element is None
            or name in body.shared
            or joint.effort == inf
            or any(m.tag == "position" and m.name == name for m in motors)
        ):
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


def load(
    body: Body, models: Path, hall: str, variation: Variation | None = None, *, backlash: bool = False
) -> mjcf.RootElement:
    """Return the hall with the robot on its stage; `hall` is a path, relative to `models` or absolute.

    The robot can fall unless its base is fixed. Raises RobotError if a file is missing, is not MJCF or lacks elements
    that the simulation needs; the error lists a file's missing elements.
    """
    world = read_hall(models, hall)
    place(world, hall, body, models, world.find("site", STAGE_SITE), backlash=backlash)
    if variation:
        _vary(world, variation)
    return world


def read_hall(models: Path, hall: str) -> mjcf.RootElement:
    """Return the hall without a robot. Raises RobotError if its file is missing, invalid or incomplete."""
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
    """Attach a robot to a world at `site`. Raises RobotError as `load` does, or if the hall and the robot clash."""
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
    """Return the robot without a world or a free joint, ready to be attached.

    Raises RobotError as `load` does, or if the body has no MJCF.
    """
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
    """Return the world as a compiled MuJoCo model. Raises RobotError if MuJoCo can't build it."""
    try:
        return mjcf.Physics.from_mjcf_model(world).model.ptr
    except Exception as error:  # The compiler raises exceptions of many types.
        raise RobotModelError(f"MuJoCo cannot build the robot in its hall: {_plain(error)}") from error


def _plain(error: Exception) -> str:
    """Return the compiler's message without dm_control's advice, hashes in file names, ids and line numbers."""
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
    except Exception as error:  # The parser raises exceptions of many types.
        reason = " ".join(str(error).split())
        raise RobotModelError(f"{path.name} is not MJCF: {reason}") from error


def _differ(robot: mjcf.RootElement, body: Body) -> None:
    """Set this body's link masses, link inertias and camera field of view: several bodies share one MJCF."""
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
