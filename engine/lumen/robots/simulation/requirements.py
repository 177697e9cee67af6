"""What the simulation asks of a robot's and a hall's MJCF."""

from collections.abc import Iterator

from dm_control import mjcf

from lumen.language.robots import Body

MAX_TIMESTEP = 0.01
"""The longest timestep [s]: the joints get their goals as often."""
MIN_TIMESTEP = 0.0001
"""The shortest [s]: with it no machine keeps real time any more."""

_HEAD = ("HeadYaw", "HeadPitch")
_LEG = ("HipYawPitch", "HipRoll", "HipPitch", "KneePitch", "AnklePitch", "AnkleRoll")
REQUIRED_JOINTS = (*_HEAD, *(side + name for side in "LR" for name in _LEG))
"""Those that looking, standing and walking name."""

_ROBOT = (("body", "Torso"), ("site", "LSole"), ("site", "RSole"), ("sensor", "gyro"), ("sensor", "accelerometer"),
          ("camera", "CameraTop"))  # fmt: skip
_EARS = (("site", "LSonar"), ("site", "RSonar"))
_HALL = (("site", "stage"), ("body", "visitor"), ("site", "visitor_face"))


def lacks_of_robot(robot: mjcf.RootElement, body: Body) -> list[str]:
    """What a robot's MJCF does not have, in words."""
    driven = [name for name in body.joints if name not in body.shared]
    needs = [*_ROBOT, *(_EARS if body.sonar else ())]
    needs += [("joint", name) for name in dict.fromkeys((*REQUIRED_JOINTS, *body.joints))]
    needs += [("actuator", name) for name in driven]
    needs += [("body", name) for name in body.links]
    return list(_lacks(robot, needs))


def lacks_of_hall(hall: mjcf.RootElement) -> list[str]:
    """What a hall's MJCF does not have, in words."""
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
        found.append(f"a timestep that fits into {MAX_TIMESTEP:g} s a whole number of times")
    return found


def lacks_of_body(body: Body) -> list[str]:
    """What a body's description does not have, in words."""
    lost = [f"the joint `{name}`" for name in REQUIRED_JOINTS if name not in body.joints]
    return lost + [f"the posture `{name}`" for name in ("Stand", "Crouch") if name not in body.postures]


def _lacks(root: mjcf.RootElement, needs: list[tuple[str, str]] | tuple[tuple[str, str], ...]) -> Iterator[str]:
    for kind, name in needs:
        if root.find(kind, name) is None:
            yield f"the {kind} `{name}`"
