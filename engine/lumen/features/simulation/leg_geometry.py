"""A body's leg dimensions, read from its MJCF: the axes' intersections in hips and ankles, and the links' lengths.

The legs' angles are computed in closed form (`LegGeometry.bend`). That requires legs that yaw, roll and pitch about one
point of the hip, pitch in the knee, and pitch and roll about one point of the ankle. Other legs are refused, with the
reason.
"""

from itertools import pairwise, product
from math import atan2, hypot
from typing import NamedTuple

import numpy as np

from lumen.errors import RobotModelError
from lumen.features.simulation.physics import mujoco
from lumen.language.robots import Body
from lumen.language.roles import LEG_ROLES
from lumen.motion.gait.legs import SIDE_ROLES, SIDES, LegGeometry, LegVector, Side, SoleSize, sign

MEETING_TOLERANCE = 1e-3
"""The tolerance [m] within which axes count as intersecting, and legs as alike."""

STRAIGHT_TOLERANCE = 0.02
"""The tolerated deviation of an axis from its direction [rad]."""

NANOMETRES = 9
"""The number of decimals kept in lengths [m] and angles [rad].

These keep the MJCF's numbers, and drop the rounding errors of their sums.
"""

TOUCHES = 0.003
"""The height above a sole up to which points belong to the sole [m]."""


class _Leg(NamedTuple):
    """One leg with all joints at zero, in the torso's frame; y points outwards."""

    hip: LegVector
    """The point where the hip's axes meet [m]."""
    inclination: float
    """The tilt of the hip yaw axis from the vertical [rad]."""
    thigh: LegVector
    """The vector from hip to knee [m]."""
    tibia: LegVector
    """The vector from knee to ankle [m]."""
    foot: float
    """The height of the ankle above the sole [m]."""
    sole_size: SoleSize
    """The distances of the sole's edges from the ankle [m]."""
    signs: tuple[float, ...]
    """For each joint, -1 if its axis points against the usual direction, else 1."""


def read_legs(model: mujoco.MjModel, body: Body) -> LegGeometry:
    """Return the geometry of a body's legs, read from its model without a world.

    Raises RobotModelError if the robot can't walk on them.
    """
    names = {side: tuple(body.roles.name(f"legs.{SIDE_ROLES[side]}.{role}") for role in LEG_ROLES) for side in SIDES}
    for side in SIDES:
        if lost := [role for role, name in zip(LEG_ROLES, names[side], strict=True) if not name]:
            raise _refused(f"the {SIDE_ROLES[side]} leg has no {', '.join(f'`{role}`' for role in lost)}")
    reader = _LegReader(model, body)
    left, right = (reader.leg(side, names[side]) for side in SIDES)
    _compare(left, right)
    shared = body.shared.get(names["R"][0]) == names["L"][0] or body.shared.get(names["L"][0]) == names["R"][0]
    if shared and left.signs[0] == right.signs[0]:
        raise _refused("both hip yaws share a motor, so it must turn them to opposite sides")
    thigh, tibia = _turned(left.thigh), _turned(left.tibia)
    offsets = tuple(round(angle, NANOMETRES) for angle in (0.0, 0.0, thigh, tibia - thigh, -tibia, 0.0))
    return LegGeometry(
        hip_ahead=_rounded(left.hip[0]),
        hip_out=_rounded(left.hip[1]),
        hip_down=_rounded(-left.hip[2]),
        thigh=_rounded(hypot(left.thigh[0], left.thigh[2])),
        tibia=_rounded(hypot(left.tibia[0], left.tibia[2])),
        foot=_rounded(left.foot),
        inclination=left.inclination,
        shared=shared,
        sole_size=left.sole_size,
        speed=min(body.joints[name].speed for name in names["L"][2:5]),
        names=names,
        signs={"L": left.signs, "R": right.signs},
        offsets=dict.fromkeys(SIDES, offsets),
    )


class _LegReader:
    def __init__(self, model: mujoco.MjModel, body: Body) -> None:
        self._model, self._body = model, body
        self._data = mujoco.MjData(model)
        joints = [model.joint(name).id for name in body.joints]
        self._data.qpos[model.jnt_qposadr[joints]] = 0.0
        mujoco.mj_kinematics(model, self._data)
        torso = self._data.body(body.roles.torso)
        self._origin, self._axes = torso.xpos.copy(), torso.xmat.reshape(3, 3).copy()

    def leg(self, side: Side, names: tuple[str, ...]) -> _Leg:
        """Return the dimensions of one leg. Raises RobotModelError if the robot can't walk on it."""
        axes = [self._axes.T @ self._data.joint(name).xaxis for name in names]
        places = [self._place(self._data.joint(name).xanchor) for name in names]
        which = f"the {SIDE_ROLES[side]} one"
        wanted = [axes[0], (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 1.0, 0.0), (0.0, 1.0, 0.0), (1.0, 0.0, 0.0)]
        signs = [1.0 if axes[0][2] > 0 else -1.0]
        for name, axis, line in zip(names[1:], axes[1:], wanted[1:], strict=True):
            along = float(axis @ np.array(line))
            if 1.0 - abs(along) > STRAIGHT_TOLERANCE**2 / 2:
                way = "ahead" if line[0] else "aside"
                raise _refused(f"the axis of `{name}` does not point straight {way} with all joints at zero")
            signs.append(1.0 if along > 0 else -1.0)
        up = signs[0] * axes[0]
        if abs(up[0]) > STRAIGHT_TOLERANCE or up[2] < STRAIGHT_TOLERANCE:
            raise _refused(f"the axis of `{names[0]}` does not point upwards with all joints at zero")
        if not self._chained(names):
            raise _refused(f"the joints of {which} are not in the order {', '.join(LEG_ROLES)}")
        hip = _meet(places[2], places[1], (names[2], names[1]))
        away = np.cross(up, hip - places[0])
        if float(np.linalg.norm(away)) > MEETING_TOLERANCE:
            raise _apart(names[0], names[1], float(np.linalg.norm(away)))
        ankle = _meet(places[4], places[5], (names[4], names[5]))
        if abs(ankle[1] - hip[1]) > MEETING_TOLERANCE:
            raise _refused(f"the ankle of {which} is {_mm(ankle[1] - hip[1])} beside its hip with all joints at zero")
        if self._knee(names[3]) * signs[3] <= 0:
            raise _refused(f"`{names[3]}` bends backwards: knees must bend forwards")
        foot, sole = self._sole(side, ankle, names[5])
        knee = np.array((places[3][0], hip[1], places[3][2]))
        inclination = atan2(-sign(side) * up[1], up[2])
        return _Leg(
            hip * (1.0, sign(side), 1.0),
            inclination if round(inclination, NANOMETRES) else 0.0,
            knee - hip,
            ankle - knee,
            foot,
            sole,
            tuple(signs),
        )

    def _chained(self, names: tuple[str, ...]) -> bool:
        """Return True if every joint in `names` carries the next."""
        order = [(int(self._model.joint(name).bodyid[0]), self._model.joint(name).id) for name in names]
        parents = self._model.body_parentid

        def carries(one: tuple[int, int], other: tuple[int, int]) -> bool:
            link = other[0]
            while link > one[0]:
                link = int(parents[link])
            return link == one[0] and one[1] < other[1]

        return all(carries(one, other) for one, other in pairwise(order))

    def _knee(self, name: str) -> float:
        """Return the sum of the knee's limits [rad]; its sign is the direction in which the knee bends."""
        joint = self._body.joints[name]
        return joint.maximum + joint.minimum

    def _sole(self, side: Side, ankle: LegVector, joint: str) -> tuple[float, SoleSize]:
        """Return the sole's depth below the ankle, and the distances of its edges from the ankle [m]."""
        name = self._body.roles.soles.get(SIDE_ROLES[side], "")
        site = self._data.site(name)
        place, axes = self._place(site.xpos), self._axes.T @ site.xmat.reshape(3, 3)
        if float(np.abs(axes - np.eye(3)).max()) > STRAIGHT_TOLERANCE:
            raise _refused(f"the site `{name}` must be flat, with x ahead and z up, when all joints are at zero")
        beside = place - ankle
        if max(abs(beside[0]), abs(beside[1])) > MEETING_TOLERANCE or beside[2] > -MEETING_TOLERANCE:
            raise _refused(
                f"the site `{name}` is {_mm(beside[0])} ahead of the ankle and {_mm(beside[1])} beside "
                "it: put it below the ankle"
            )
        link = int(self._model.joint(joint).bodyid[0])
        points = [point for geom in self._touching(link) for point in _outline(self._model, self._data, geom)]
        seen = np.array([self._place(point) for point in points]).reshape(-1, 3) - place
        touching = seen[np.abs(seen[:, 2]) < TOUCHES]
        if len(touching) < 2 or np.ptp(touching[:, 0]) < TOUCHES or np.ptp(touching[:, 1]) < TOUCHES:
            raise _refused(f"no flat part of `{self._model.body(link).name}` touches the ground at the site `{name}`")
        out = sign(side) * touching[:, 1]
        toe, heel, outer, inner = touching[:, 0].max(), -touching[:, 0].min(), out.max(), -out.min()
        return -beside[2], SoleSize(_rounded(toe), _rounded(heel), _rounded(outer), _rounded(inner))

    def _touching(self, link: int) -> list[int]:
        """Return the geoms of a link that can touch something."""
        first, count = self._model.body_geomadr[link], self._model.body_geomnum[link]
        solid = self._model.geom_contype | self._model.geom_conaffinity
        return [geom for geom in range(first, first + count) if solid[geom]]

    def _place(self, point: LegVector) -> LegVector:
        """Return a point of the world frame in the torso's frame [m]."""
        seen: LegVector = self._axes.T @ (point - self._origin)
        return seen


def _outline(model: mujoco.MjModel, data: mujoco.MjData, geom: int) -> LegVector:
    """Return the points of a geom's surface that can touch the ground [m]: Shape (points, 3)."""
    size, axes, place = model.geom_size[geom], data.geom_xmat[geom].reshape(3, 3), data.geom_xpos[geom]
    below = 0.0
    match mujoco.mjtGeom(model.geom_type[geom]):
        case mujoco.mjtGeom.mjGEOM_MESH:
            mesh = model.geom_dataid[geom]
            first, count = model.mesh_vertadr[mesh], model.mesh_vertnum[mesh]
            own = model.mesh_vert[first : first + count].astype(float)
        case mujoco.mjtGeom.mjGEOM_BOX:
            own = np.array(list(product((-1.0, 1.0), repeat=3))) * size
        case mujoco.mjtGeom.mjGEOM_CAPSULE:
            own, below = np.array([(0.0, 0.0, -size[1]), (0.0, 0.0, size[1])]), size[0]
        case _:
            own, below = np.zeros((1, 3)), size[0]
    points: LegVector = own @ axes.T + place - (0.0, 0.0, below)
    return points


def _compare(left: _Leg, right: _Leg) -> None:
    """Raise RobotModelError if the legs are not mirror images of each other."""
    pairs = [
        ("hips", left.hip, right.hip),
        ("thighs", left.thigh, right.thigh),
        ("shanks", left.tibia, right.tibia),
        ("feet", np.array(left.foot), np.array(right.foot)),
        ("soles", np.array(left.sole_size), np.array(right.sole_size)),
    ]
    for what, one, other in pairs:
        if (differs := float(np.abs(one - other).max())) > MEETING_TOLERANCE:
            raise _refused(f"the two {what} differ by {_mm(differs)}")
    if abs(left.inclination - right.inclination) > STRAIGHT_TOLERANCE:
        raise _refused("the axes of the hip yaws are not tilted by the same angle")


def _meet(pitch: LegVector, roll: LegVector, names: tuple[str, str]) -> LegVector:
    """Return the intersection of a lateral axis with an axis that points ahead.

    Raises RobotModelError if the axes do not intersect.
    """
    if (apart := abs(float(pitch[2] - roll[2]))) > MEETING_TOLERANCE:
        raise _apart(names[0], names[1], apart)
    return np.array((pitch[0], roll[1], pitch[2]))


def _turned(link: LegVector) -> float:
    """Return the pitch of a link from straight down [rad]."""
    return atan2(-link[0], -link[2])


def _rounded(length: float) -> float:
    return round(float(length), NANOMETRES)


def _mm(length: float) -> str:
    return f"{1000 * abs(float(length)):.1f} mm"


def _apart(one: str, other: str, length: float) -> RobotModelError:
    return _refused(f"the axes of `{one}` and `{other}` are {_mm(length)} apart: they must intersect")


def _refused(reason: str) -> RobotModelError:
    return RobotModelError(f"the robot cannot walk on its legs: {reason}")
