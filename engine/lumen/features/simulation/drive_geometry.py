"""Dimensions and limits of a body's driven wheels, read from its MJCF."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lumen.errors import RobotModelError
from lumen.features.simulation.physics import mujoco
from lumen.features.simulation.world import World
from lumen.motion.gait.pendulum import GRAVITY

TIPPING_SHARE = 0.25
"""The share that the robot uses of its maximum acceleration, which tipping or the motors' force limits."""

ON_THE_GROUND = 0.01
"""The height above the wheels' lowest points up to which geoms carry the robot [m]."""


_ROUND = [
    int(kind) for kind in (mujoco.mjtGeom.mjGEOM_CYLINDER, mujoco.mjtGeom.mjGEOM_SPHERE, mujoco.mjtGeom.mjGEOM_CAPSULE)
]


class DriveGeometry(NamedTuple):
    """The dimensions and limits of two driven wheels side by side."""

    angles: NDArray[np.intp]
    """The indices of the wheels' joints in MuJoCo's `qpos`, left first."""
    motors: NDArray[np.intp]
    """The indices of the wheels' actuators in MuJoCo's model."""
    signs: NDArray[np.float64]
    """1 for a wheel that rolls ahead with a positive angle, else -1."""
    radius: float
    """A wheel's radius [m]."""
    track: float
    """The distance between the wheels [m]."""
    fastest: float
    """The maximum rolling speed [m/s]."""
    acceleration: float
    """The maximum linear acceleration and deceleration [m/s^2]."""
    spin: float
    """The maximum angular acceleration and deceleration [rad/s^2]."""
    reach: float
    """The maximum distance of the wheels and casters from the midpoint between the wheels [m]."""


def read_drive(world: World) -> DriveGeometry:
    """Return the geometry of a robot's driven wheels. Raises RobotModelError if the robot can't drive on them."""
    model, data, base = world.model, world.data, world.body.roles.base
    torso = data.body(world.torso)
    axes, names = torso.xmat.reshape(3, 3), (base.left, base.right)
    joints = [model.joint(f"{world.prefix}/{name}") for name in names]
    motors = [_motor(model, joint.id) for joint in joints]
    places = [axes.T @ (data.joint(joint.id).xanchor - torso.xpos) for joint in joints]
    ways = [axes.T @ data.joint(joint.id).xaxis for joint in joints]
    radii = [_radius(model, int(joint.bodyid[0])) for joint in joints]
    for name, joint, way, radius in zip(names, joints, ways, radii, strict=True):
        if joint.type[0] != mujoco.mjtJoint.mjJNT_HINGE or abs(way[1]) < 0.99:
            raise _refused(f"`{name}` is not a hinge with an axis that points straight to the side")
        if radius <= 0.0:
            raise _refused(f"the wheel of `{name}` has no round geom that touches the ground")
    track = float(places[0][1] - places[1][1])
    if abs(radii[0] - radii[1]) > 1e-3 or abs(places[0][0] - places[1][0]) > 1e-3 or track <= 0.0:
        raise _refused("the wheels must have the same size and be side by side, the left one on the left")
    radius = radii[0]
    fastest = min(float(model.actuator_ctrlrange[motor, 1]) or np.inf for motor in motors) * radius
    force = sum(float(model.actuator_forcerange[motor, 1]) or np.inf for motor in motors) / radius
    carried = _carried(world, radius, float(places[0][2]))
    mass, centre = _mass(world)
    height = float(centre[2] - places[0][2] + radius)
    near = min(float(carried[:, 0].max() - centre[0]), float(centre[0] - carried[:, 0].min()))
    if near <= 0.0:
        raise _refused("its centre of mass is not above its wheels and casters")
    acceleration = TIPPING_SHARE * min(GRAVITY * near / height, force / mass)
    return DriveGeometry(
        np.array([joint.qposadr[0] for joint in joints]),
        np.array(motors),
        np.array([1.0 if way[1] > 0 else -1.0 for way in ways]),
        radius,
        track,
        fastest,
        acceleration,
        acceleration / (track / 2),
        float(np.hypot(carried[:, 0] - places[0][0], carried[:, 1]).max()),
    )


def _motor(model: mujoco.MjModel, joint: int) -> int:
    """Return the index of the actuator that turns a joint."""
    turned = (model.actuator_trntype == mujoco.mjtTrn.mjTRN_JOINT) & (model.actuator_trnid[:, 0] == joint)
    return int(np.flatnonzero(turned)[0])


def _radius(model: mujoco.MjModel, link: int) -> float:
    """Return the radius of a link's largest round geom that can touch something [m]; 0 if it has none."""
    geoms = np.arange(model.body_geomadr[link], model.body_geomadr[link] + model.body_geomnum[link])
    solid = (model.geom_contype[geoms] | model.geom_conaffinity[geoms]).astype(bool)
    radii = model.geom_size[geoms[solid & np.isin(model.geom_type[geoms], _ROUND)], 0]
    return float(radii.max(initial=0.0))


def _carried(world: World, radius: float, axle: float) -> NDArray[np.float64]:
    """Return the positions of the wheels and of other geoms that reach the ground, such as casters.

    They are points in the torso's frame, Shape (points, 2) [m].
    """
    model, data, torso = world.model, world.data, world.data.body(world.torso)
    own = (model.geom_contype | model.geom_conaffinity) & (
        model.body_rootid[model.geom_bodyid] == model.body_rootid[world.torso]
    )
    found = []
    for geom in np.flatnonzero(own):
        axes = torso.xmat.reshape(3, 3).T @ data.geom_xmat[geom].reshape(3, 3)
        place = torso.xmat.reshape(3, 3).T @ (data.geom_xpos[geom] - torso.xpos)
        low = place[2] - float(np.abs(axes[2]) @ model.geom_aabb[geom, 3:])
        if low < axle - radius + ON_THE_GROUND:
            found.append(place[:2])
    return np.array(found)


def _mass(world: World) -> tuple[float, NDArray[np.float64]]:
    """Return the whole robot's mass [kg] and its centre in the torso's frame [m], Shape (3,)."""
    root, torso = int(world.model.body_rootid[world.torso]), world.data.body(world.torso)
    centre: NDArray[np.float64] = torso.xmat.reshape(3, 3).T @ (world.data.subtree_com[root] - torso.xpos)
    return float(world.model.body_subtreemass[root]), centre


def _refused(reason: str) -> RobotModelError:
    return RobotModelError(f"the robot cannot drive on its wheels: {reason}")
