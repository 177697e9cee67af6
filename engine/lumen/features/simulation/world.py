"""One robot's running physics: state, sensors and simulated time."""

from collections.abc import Mapping
from math import acos, pi
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lumen.errors import RobotModelError
from lumen.features.simulation.joint_envelope import JointVector
from lumen.features.simulation.model_terms import PLAY_SUFFIX, ROBOT_PREFIX, Variation
from lumen.features.simulation.physics import Physics, mujoco
from lumen.features.simulation.world_model import physics
from lumen.language.robots import Body
from lumen.language.roles import SIDES

CONTROL_PERIOD = 0.01
"""The time between two joint commands [s]."""

_UNSTABLE = [
    int(w)
    for w in (mujoco.mjtWarning.mjWARN_BADQPOS, mujoco.mjtWarning.mjWARN_BADQVEL, mujoco.mjtWarning.mjWARN_BADQACC)
]


class World:
    """MuJoCo's model and state, read in the body's joint order. Only the thread that steps the world may use it.

    `model` and `data` are MuJoCo's; `physics` is dm_control's view of the same memory. Several robots can share one
    world, passed as `shared`. The names of each robot's elements begin with its `prefix`.
    """

    def __init__(
        self,
        body: Body,
        models: Path,
        hall: str,
        variation: Variation | None = None,
        *,
        backlash: bool = False,
        shared: Physics | None = None,
        prefix: str = ROBOT_PREFIX,
    ) -> None:
        self.body, self.prefix = body, prefix
        self.physics = shared or physics(body, models, hall, variation, backlash=backlash)
        self.model: mujoco.MjModel = self.physics.model.ptr
        self.data: mujoco.MjData = self.physics.data.ptr
        if self.model.ntree == 1:  # a lone robot is one island: searching for more costs time
            self.model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_ISLAND
        joints = [self.model.joint(f"{prefix}/{name}") for name in body.joints]
        self._angles = np.array([j.qposadr[0] for j in joints])
        self._speeds = np.array([j.dofadr[0] for j in joints])
        straight = (*body.hands, *body.slides)
        loose = {i: name for i, name in enumerate(body.joints) if backlash and name not in straight}
        plays = [self.model.joint(f"{prefix}/{name}{PLAY_SUFFIX}") for name in loose.values()]
        self._loose, self._plays = np.array(list(loose), np.intp), np.array([p.qposadr[0] for p in plays], np.intp)
        driven = [i for i, name in enumerate(body.joints) if name not in body.shared]
        names = list(body.joints)
        self.driven = np.array(driven)
        self._driving = self._speeds[driven]
        self.actuators = np.array([self.model.actuator(f"{prefix}/{names[i]}").id for i in driven])
        roles = body.roles
        self.torso = self.model.body(f"{prefix}/{roles.torso}").id
        self.free = roles.base.row.moves
        """True if the robot can leave its point of attachment."""
        self._soles = [f"{prefix}/{roles.soles[side]}" for side in SIDES if side in roles.soles]
        self._root = self.model.joint(f"{prefix}/").qposadr[0] if self.free else 0
        self._accelerometer = self._sensor(roles.sensors.accelerometer)
        gyro = roles.sensors.gyro
        self.gyro_axes: NDArray[np.float64] | None = None
        """The gyrometer's present axes, Shape (9,), a view that MuJoCo updates; None if the body has no gyrometer."""
        if gyro:
            self.gyro_axes = self.data.site_xmat[self.model.sensor(f"{prefix}/{gyro}").objid[0]]
        self._torso_axes = self.data.xmat[self.torso]
        self._substeps = round(CONTROL_PERIOD / self.model.opt.timestep)
        self._warnings = self.data.warning.number
        self._start: NDArray[np.float64] = self.data.qpos[self._root : self._root + 7].copy()

    def step(self) -> None:
        """Advance one control period.

        Like dm_control's `step`, leave everything that depends on the positions up to date.
        """
        mujoco.mj_step2(self.model, self.data)
        mujoco.mj_step(self.model, self.data, self._substeps - 1)
        mujoco.mj_step1(self.model, self.data)

    def check(self) -> None:
        """Raise RobotError if MuJoCo has warned of non-finite or too large positions, speeds or accelerations."""
        if self._warnings[_UNSTABLE].any():
            raise RobotModelError(
                "the simulation has become unstable: check the positions, sizes and forces in models/"
            )

    @property
    def angles(self) -> JointVector:
        """The joints' angles, including the play of their gears [rad; hands 0..1]."""
        qpos = self.data.qpos
        measured: JointVector = qpos.take(self._angles)
        measured[self._loose] += qpos.take(self._plays)
        return measured

    @property
    def speeds(self) -> JointVector:
        """The speeds at which the motors turn the joints [rad/s]."""
        measured: JointVector = self.data.qvel[self._speeds]
        return measured

    @property
    def motor_speeds(self) -> NDArray[np.float64]:
        """The speeds of the joints with a motor, in the order of `actuators` [rad/s]."""
        speeds: NDArray[np.float64] = self.data.qvel.take(self._driving)
        return speeds

    @property
    def torques(self) -> JointVector:
        """The motors' torques by joint [N m]; 0 for a joint that another joint's motor moves."""
        torques = np.zeros(len(self.body.joints))
        torques[self.driven] = self.data.actuator_force[self.actuators]
        return torques

    @property
    def acceleration(self) -> tuple[float, float, float]:
        """The accelerometer's reading in the torso's axes: forward, left, up [m/s^2]; zeros without a sensor."""
        x, y, z = self._felt(self._accelerometer)
        return x, y, z

    @property
    def up(self) -> tuple[float, float, float]:
        """The unit vector that points up, in the torso's axes: forward, left, up."""
        forward, left, up = self._torso_axes[6:9].tolist()
        return forward, left, up

    @property
    def tilt(self) -> float:
        """The angle between the torso's upward axis and the vertical [rad]."""
        return acos(min(1.0, max(-1.0, float(self._torso_axes[8]))))

    def set_up(self, angles: Mapping[str, float]) -> None:
        """Put the robot on its stage in this posture, with the stage's site midway between its feet.

        The left sole is laid flat, and the feet point symmetrically about straight ahead. A robot without two feet is
        placed with its lowest point at the site; a fixed base stays in place. Use this only to begin a run: afterwards,
        only the motors move the robot. Raises RobotError if a geom's position is not finite.
        """
        data, root = self.data, self._root
        data.qpos[self._angles] = [angles[name] for name in self.body.joints]
        if self.free:
            data.qpos[root : root + 7] = self._start
            mujoco.mj_kinematics(self.model, data)
            if len(self._soles) == 2:
                axes = [data.site(name).xmat.reshape(3, 3) for name in self._soles]
                start = np.zeros(9)
                mujoco.mju_quat2Mat(start, self._start[3:])
                mujoco.mju_mulQuat(
                    data.qpos[root + 3 : root + 7],
                    self._start[3:],
                    _upright(start.reshape(3, 3).T @ axes[0], start.reshape(3, 3).T @ axes[1]),
                )
                mujoco.mj_kinematics(self.model, data)
                soles = np.array([data.site(name).xpos for name in self._soles])
                middle = np.array([*soles[:, :2].mean(axis=0), soles[:, 2].min()])
            else:
                middle = np.array([*self._start[:2], self._lowest()])
            data.qpos[root : root + 3] += self._start[:3] - middle
        data.ctrl[self.actuators] = data.qpos[self._angles][self.driven]
        self.physics.forward()
        lost = [self.model.geom(i).name or "a geom without a name" for i in _nowhere(data.geom_xpos)]
        if lost:
            raise RobotModelError(f"geoms in models/ have a position that is not a number: {', '.join(lost)}")

    def _lowest(self) -> float:
        """Return the height of the lowest point of the robot's geoms that can touch something [m]."""
        model, data = self.model, self.data
        whole = model.body_rootid[self.torso]
        touching = (model.geom_contype | model.geom_conaffinity).astype(bool)
        own = np.flatnonzero(touching & (model.body_rootid[model.geom_bodyid] == whole))
        axes = data.geom_xmat[own].reshape(-1, 3, 3)[:, 2, :]
        centre, half = model.geom_aabb[own, :3], model.geom_aabb[own, 3:]
        return float((data.geom_xpos[own, 2] + (axes * centre).sum(1) - (np.abs(axes) * half).sum(1)).min())

    def _sensor(self, name: str) -> int:
        """Return the index of a sensor's first reading; -1 if `name` is empty."""
        return int(self.model.sensor(f"{self.prefix}/{name}").adr[0]) if name else -1

    def _felt(self, sensor: int) -> tuple[float, float, float]:
        if sensor < 0:
            return 0.0, 0.0, 0.0
        x, y, z = self.data.sensordata[sensor : sensor + 3].tolist()
        return x, y, z


def _nowhere(places: NDArray[np.float64]) -> NDArray[np.intp]:
    return np.flatnonzero(~np.isfinite(places).all(axis=1))


def _upright(left: NDArray[np.float64], right: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the quaternion that lays the left sole flat and turns both soles symmetrically about straight ahead.

    The arguments are the soles' axes in the upright torso's frame, Shape (3, 3) each.
    """
    flat = left.T
    other = flat @ right
    turn = -0.5 * np.arctan2(other[1, 0], other[0, 0])
    cos, sin = np.cos(turn), np.sin(turn)
    ahead = np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])
    quaternion = np.zeros(4)
    mujoco.mju_mat2Quat(quaternion, (ahead @ flat).ravel())
    return quaternion


FALLEN_TILT = pi / 4
"""The tilt of the torso above which the robot counts as fallen, more than in any motion [rad]."""
