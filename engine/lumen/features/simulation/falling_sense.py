"""The robot's estimate of its centre of mass and direction of fall, from its own sensors."""

from collections.abc import Mapping
from math import hypot, sqrt
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lumen.errors import RobotModelError
from lumen.features.simulation.physics import mujoco
from lumen.features.simulation.sensors import BodySensors
from lumen.features.simulation.world import CONTROL_PERIOD
from lumen.language.robots import Body
from lumen.language.roles import SIDES
from lumen.motion.gait import LegGeometry
from lumen.motion.gait.parameters import scale_of
from lumen.motion.gait.pendulum import GRAVITY
from lumen.project.packaged_models import mjcf_path


class MassModel:
    """The robot's model without a world, for computing centres of mass.

    Raises RobotModelError if the MJCF is invalid.
    """

    def __init__(self, body: Body, models: Path) -> None:
        try:
            spec = mujoco.MjSpec.from_file(str(mjcf_path(body.mjcf, models)))
            spec.compiler.discardvisual = True
            for name, link in body.links.items():
                differs = spec.body(name)
                differs.mass, differs.ipos, differs.fullinertia = link.mass, link.centre, link.inertia
            self.model: mujoco.MjModel = spec.compile()
        except ValueError as error:
            raise RobotModelError(f"{body.mjcf} is not MJCF: {' '.join(str(error).split())}") from error
        self._data = mujoco.MjData(self.model)
        self._places = {name: self.model.joint(name).qposadr[0] for name in body.joints}
        self._torso = self.model.body(body.roles.torso).id
        at, turned = self.model.body_pos[self._torso], self.model.body_quat[self._torso]
        root = self.model.body_parentid[self._torso] == 0 and not self.model.body_jntnum[self._torso]
        self._torso_is_world = bool(root and not at.any() and turned[0] == 1.0)
        self._whole = self.model.body_rootid[self._torso]
        self._order = np.array(list(self._places.values()))
        soles = [body.roles.soles[side] for side in SIDES if side in body.roles.soles]
        self._soles = np.array([self.model.site(name).id for name in soles], np.intp)

    def pose(self, angles: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return the centre of mass, Shape (3,), and the soles' sites, Shape (2, 3), in the torso's frame [m].

        `angles` are the angles of all joints in the body's order [rad].
        """
        self._data.qpos[self._order] = angles
        mujoco.mj_kinematics(self.model, self._data)
        mujoco.mj_comPos(self.model, self._data)
        return self._seen(self._data.subtree_com[self._whole]), self._seen(
            self._data.site_xpos.take(self._soles, axis=0)
        )

    def centre_of_mass(self, angles: Mapping[str, float]) -> NDArray[np.float64]:
        """Return the centre of mass, Shape (3,), in the torso's frame [m].

        Joints that are not in `angles` [rad] keep their last value.
        """
        for name, angle in angles.items():
            self._data.qpos[self._places[name]] = angle
        mujoco.mj_kinematics(self.model, self._data)
        mujoco.mj_comPos(self.model, self._data)
        return self._seen(self._data.subtree_com[self._whole])

    def _seen(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return points of the world frame, Shape (..., 3), in the torso's frame [m]."""
        if self._torso_is_world:
            return points.copy()
        seen: NDArray[np.float64] = (points - self._data.xpos[self._torso]) @ self._data.xmat[self._torso].reshape(3, 3)
        return seen


_SMOOTHING = 0.65
_LOWEST = 0.15
"""The minimum assumed height of the centre of mass [m], for the leg length with which the paces were tuned."""


class FallingSense:
    """The centre of mass and its divergent component of motion (DCM), relative to the feet.

    Axes are level with the ground: forward along the torso's heading, left, up [m]. The estimate uses the encoders, the
    inertial unit and the published masses, so a load or a difference in build makes it wrong. The DCM is the ground
    point that must bear the weight for the body to come to a halt above it: the capture point of Pratt and others,
    "Capture point: a step toward humanoid push recovery", 2006. In two-row arrays, the first row is the left foot's.
    """

    def __init__(self, sensors: BodySensors, mass_model: MassModel, legs: LegGeometry) -> None:
        self._sensors, self._mass_model = sensors, mass_model
        self._lowest = _LOWEST * scale_of(legs)
        self._sole = legs.sole_size
        self._ahead = 0.0
        self._left, self._right = (0.0, 0.0), (0.0, 0.0)
        self._speed = np.zeros((2, 3))
        self._felt = False
        self.axes: NDArray[np.float64] = np.eye(3)
        """The forward, left and up axes in the torso's frame, Shape (3, 3)."""
        self.soles: NDArray[np.float64] = np.zeros((2, 3))
        """Both soles, relative to the torso."""
        self.mass: NDArray[np.float64] = np.zeros((2, 3))
        """The centre of mass, relative to each sole."""
        self.dcm: NDArray[np.float64] = np.zeros((2, 2))
        """The DCM on the ground, relative to each sole."""
        self.omega = 6.0
        """The rate at which the DCM diverges from the centre of pressure [1/s]."""

    @property
    def ahead(self) -> float:
        """The distance of the centre of mass in front of the ankles [m]; negative behind them."""
        return self._ahead

    @property
    def behind_heels(self) -> float:
        """The distance of the DCM behind the feet's rear edge [m]; negative in front of the edge."""
        return -self._sole[1] - max(self._left[0], self._right[0])

    @property
    def beyond(self) -> tuple[float, float, float, float]:
        """The distances of the DCM beyond the front, rear, left and right edges of both feet [m]; negative inside."""
        toe, heel, outer, inner = self._sole
        (left_x, left_y), (right_x, right_y) = self._left, self._right
        ahead, behind = toe - min(left_x, right_x), -heel - max(left_x, right_x)
        return -ahead, behind, -max(outer - left_y, inner - right_y), min(-inner - left_y, -outer - right_y)

    @property
    def aside(self) -> float:
        """The distance of the DCM to the left of the midpoint between the feet [m]; negative to the right."""
        return (self._left[1] + self._right[1]) / 2

    @property
    def far(self) -> tuple[float, float]:
        """The horizontal distances of the DCM from the left and right ankles [m]."""
        return hypot(*self._left), hypot(*self._right)

    def feel(self) -> None:
        """Update the estimate; call this once in each control period."""
        x, y, z = self._sensors.up
        level = hypot(y, z)
        self.axes = np.array(((level, -x * y / level, -x * z / level), (0.0, z / level, -y / level), (x, y, z)))
        com, soles = self._mass_model.pose(self._sensors.angles)
        self.soles = soles @ self.axes.T
        here = (com - soles) @ self.axes.T
        before = self.mass if self._felt else here
        self._speed = _SMOOTHING * self._speed + (1 - _SMOOTHING) * (here - before) / CONTROL_PERIOD
        self.mass, self._felt = here, True
        (left, _, left_height), (right, _, right_height) = here.tolist()
        self._ahead = (left + right) / 2
        self.omega = sqrt(GRAVITY / max(left_height, right_height, self._lowest))
        self.dcm = here[:, :2] + self._speed[:, :2] / self.omega
        self._left, self._right = self.dcm.tolist()
