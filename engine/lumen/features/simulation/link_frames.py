"""The poses and shapes of a robot's links for given joint angles, computed without simulation."""

from collections.abc import Iterator, Mapping
from math import cos, sin
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lumen.features.simulation.model import alone
from lumen.features.simulation.physics import mjcf, mujoco
from lumen.language.robots import Body
from lumen.ports import Joints
from lumen.robot.links import FLOOR, LinkFrame, LinkShape

LinkNumbers = NDArray[np.float64]
SEEN_GROUP = 2
"""The geom group of the visible geoms."""


class LinkFrames:
    """The links of a body whose MJCF is in the folder `models`. Raises RobotModelError if the model can't be built."""

    def __init__(self, body: Body, models: Path) -> None:
        self._model = mjcf.Physics.from_mjcf_model(alone(body, models)).model.ptr
        self._data = mujoco.MjData(self._model)
        names = (self._model.joint(number).name for number in range(self._model.njnt))
        self._places = {name: int(self._model.jnt_qposadr[number]) for number, name in enumerate(names)}
        self._names = [self._model.body(number).name for number in range(self._model.nbody)]

    def frames(self, joints: Joints) -> Iterator[LinkFrame]:
        """Yield each link with its pose in its parent's frame.

        The first link's pose is in the hall's frame, with the robot's lowest point on the floor.
        """
        model, data = self._model, self._data
        for name, angle in zip(joints.names, joints.angles, strict=True):
            if (place := self._places.get(name)) is not None:
                data.qpos[place] = angle
        self._follow()
        where = joints.position
        x, y, theta = (where.x, where.y, where.theta) if where else (0.0, 0.0, 0.0)
        model.body_quat[1] = _rotation(joints.inertial, theta)
        model.body_pos[1] = x, y, 0.0
        mujoco.mj_kinematics(model, data)
        parents = model.body_parentid
        axes = data.xmat.reshape(-1, 3, 3)[parents]
        positions = np.einsum("nji,nj->ni", axes, data.xpos - data.xpos[parents])
        positions[1, 2] -= self._lowest()
        rotations = _product(data.xquat[parents] * (1.0, -1.0, -1.0, -1.0), data.xquat)
        for number in range(1, model.nbody):
            parent = self._names[parents[number]] if parents[number] else FLOOR
            yield LinkFrame(self._names[number], parent, positions[number], rotations[number])

    def shapes(self) -> Iterator[LinkShape]:
        """Yield the visible shapes of the links."""
        model, none = self._model, np.zeros((0, 3))
        for number in np.flatnonzero(model.geom_group == SEEN_GROUP):
            kind = mujoco.mjtGeom(model.geom_type[number]).name.removeprefix("mjGEOM_").lower()
            vertices, faces = none, np.zeros((0, 3), np.int32)
            if kind == "mesh":
                mesh = model.geom_dataid[number]
                first, count = model.mesh_vertadr[mesh], model.mesh_vertnum[mesh]
                vertices = model.mesh_vert[first : first + count]
                first, count = model.mesh_faceadr[mesh], model.mesh_facenum[mesh]
                faces = model.mesh_face[first : first + count]
            material = model.geom_matid[number]
            colour = model.mat_rgba[material] if material >= 0 else model.geom_rgba[number]
            link = self._names[model.geom_bodyid[number]]
            pose = model.geom_pos[number], model.geom_quat[number]
            yield LinkShape(link, kind, *pose, model.geom_size[number], colour, vertices, faces)

    def _follow(self) -> None:
        """Set the joints that follow another joint, such as fingers and the second hip yaw."""
        model, data = self._model, self._data
        for number in np.flatnonzero(model.eq_type == mujoco.mjtEq.mjEQ_JOINT):
            one, other = model.eq_obj1id[number], model.eq_obj2id[number]
            if other >= 0:
                turned = data.qpos[model.jnt_qposadr[other]]
                data.qpos[model.jnt_qposadr[one]] = np.polyval(model.eq_data[number][4::-1], turned)

    def _lowest(self) -> float:
        """Return the height of the robot's lowest point [m]."""
        model, data = self._model, self._data
        axes = data.geom_xmat.reshape(-1, 3, 3)[:, 2, :]
        centre, half = model.geom_aabb[:, :3], model.geom_aabb[:, 3:]
        return float((data.geom_xpos[:, 2] + (axes * centre).sum(1) - (np.abs(axes) * half).sum(1)).min())


def _rotation(inertial: Mapping[str, float], theta: float) -> LinkNumbers:
    """Return the torso's rotation as a quaternion: `theta` [rad], then the tilt by the inertial unit's angles."""
    turned = np.array([1.0, 0.0, 0.0, 0.0])
    for angle, axis in ((theta, 3), (inertial.get("AngleY", 0.0), 2), (inertial.get("AngleX", 0.0), 1)):
        other = np.zeros(4)
        other[0], other[axis] = cos(angle / 2), sin(angle / 2)
        turned = _product(turned, other)
    return turned


def _product(one: LinkNumbers, other: LinkNumbers) -> LinkNumbers:
    """Return the product of quaternions (w, x, y, z): first `other`, then `one`."""
    a, b = one[..., :1], other[..., :1]
    u, v = one[..., 1:], other[..., 1:]
    return np.concatenate((a * b - (u * v).sum(-1, keepdims=True), a * v + b * u + np.cross(u, v)), axis=-1)
