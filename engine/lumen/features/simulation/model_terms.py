"""The MJCF elements that the simulation needs in a robot and a hall, and the names of those that it adds."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from lumen.features.simulation.physics import mjcf
from lumen.language.robots import Body
from lumen.language.roles import LEG_ROLES, SIDES

ROBOT_PREFIX = "nao"
"""The prefix of the robot's element names in the hall: `nao/`, then the name in the model."""

STAGE_SITE = "stage"
"""The hall's site on which the robot is placed."""

PLAY_SUFFIX = "Play"
"""The name suffix of a joint that models a gear's play, such as `LKneePitchPlay`."""


@dataclass(frozen=True, slots=True)
class Variation:
    """The differences between a robot in its hall and their models."""

    mass: float = 1.0
    """The factor of all masses."""
    friction: float = 1.0
    """The factor of all geoms' friction, including the ground's."""


MAX_TIMESTEP = 0.01
"""The maximum timestep [s]: the period of the joint commands."""
MIN_TIMESTEP = 0.0001
"""The minimum timestep [s]: with a shorter one, no computer keeps up with real time."""

_HALL = (("site", "stage"), ("body", "visitor"), ("site", "visitor_face"))


def lacks_of_robot(robot: mjcf.RootElement, body: Body) -> list[str]:
    """Return descriptions of the elements that a body or its roles name but its MJCF lacks."""
    roles, base = body.roles, body.roles.base
    driven = [name for name in body.joints if name not in body.shared]
    named = [
        ("body", roles.torso),
        ("camera", roles.eyes.camera),
        ("body", roles.eyes.face),
        *(("site", site) for site in roles.soles.values()),
        ("sensor", roles.sensors.gyro),
        ("sensor", roles.sensors.accelerometer),
        *(("site", site) for site in (roles.sensors.sonar.values() if body.sonar else ())),
        *(("site", site) for sites in roles.sensors.force.values() for site in sites),
        *(("joint", name) for name in (base.left, base.right)),
        *(("joint", name) for name in body.joints),
        *(("actuator", name) for name in driven),
        *(("body", name) for name in body.links),
    ]
    found = list(_lacks(robot, dict.fromkeys(need for need in named if need[1])))
    wheels = [name for name in (base.left, base.right) if name and robot.find("joint", name) is not None]
    return found + [f"a velocity actuator for the wheel `{name}`" for name in wheels if not wheel_motor(robot, name)]


def wheel_motor(robot: mjcf.RootElement, wheel: str) -> str:
    """Return the name of the velocity actuator that turns a wheel's joint; empty without such an actuator."""
    motors = (motor for motor in robot.find_all("actuator") if motor.tag == "velocity")
    return next((motor.name for motor in motors if motor.joint is not None and motor.joint.name == wheel), "")


def lacks_of_hall(hall: mjcf.RootElement) -> list[str]:
    """Return descriptions of the required elements and settings that a hall's MJCF lacks."""
    found = list(_lacks(hall, _HALL))
    visitor = hall.find("body", "visitor")
    if visitor is not None and not visitor.mocap:
        found.append('mocap="true" at its body `visitor`')
    if visitor is not None and not visitor.geom:
        found.append("a geom in its body `visitor`")
    timestep = hall.option.timestep or MAX_TIMESTEP
    if not MIN_TIMESTEP <= timestep <= MAX_TIMESTEP:
        found.append(f"a timestep from {MIN_TIMESTEP:g} to {MAX_TIMESTEP:g} s")
    elif abs(MAX_TIMESTEP / timestep - round(MAX_TIMESTEP / timestep)) > 1e-6:
        found.append(f"a timestep that divides {MAX_TIMESTEP:g} s evenly")
    return found


def lacks_of_body(body: Body) -> list[str]:
    """Return descriptions of the roles, joints and postures that a body lacks for the simulation."""
    roles = body.roles
    if not roles.torso:
        return ["the role `torso`"]
    lost = [f"the joint `{role.joint}`" for role in roles.paths.values() if role.joint not in body.joints]
    base = roles.base.row
    if base.legs:
        legs = [f"legs.{side}.{name}" for side in SIDES for name in LEG_ROLES]
        lost += [f"the role `{path}`" for path in legs if not roles.joint(path)]
        lost += [f"the role `soles.{side}`" for side in SIDES if not roles.soles.get(side)]
    if base.wheels:
        lost += [f"the role `base.{side}`" for side in SIDES if not getattr(roles.base, side)]
    if base.moves:
        lost += [f"the role `sensors.{name}`" for name in ("gyro", "accelerometer") if not getattr(roles.sensors, name)]
    needed = ("Stand", "Crouch") if base.legs else ("Stand",)
    return lost + [f"the posture `{name}`" for name in needed if name not in body.postures]


def _lacks(root: mjcf.RootElement, needs: Iterable[tuple[str, str]]) -> Iterator[str]:
    for kind, name in needs:
        if root.find(kind, name) is None:
            yield f"the {kind} `{name}`"
