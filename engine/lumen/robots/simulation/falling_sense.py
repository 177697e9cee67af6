"""Where the robot falls to, by what it measures of itself."""

from math import hypot, sqrt

import numpy as np
from numpy.typing import NDArray

from lumen.interpreters.gait import LegGeometry
from lumen.interpreters.gait.parameters import scale_of
from lumen.interpreters.gait.pendulum import GRAVITY
from lumen.robots.simulation.mass_model import MassModel
from lumen.robots.simulation.sensors import BodySensors
from lumen.robots.simulation.world import CONTROL_PERIOD

_SMOOTHING = 0.65
_LOWEST = 0.15
"""The centre of mass is never taken for lower than this [m], above legs as long as those that paces were found with."""


class FallingSense:
    """The centre of mass and its divergent component of motion (DCM), as seen from the feet.

    Level with the ground: forward along the torso's heading, left, up [m]. From encoders, the inertial unit and the
    published masses alone: what the robot carries, and how it was built, it does not know. The DCM is where the weight
    would have to rest for the body to come to a halt there: the capture point of Pratt and others, "Capture point: a
    step toward humanoid push recovery", 2006. The first row of what has two is of the left foot.
    """

    def __init__(self, sensors: BodySensors, mass_model: MassModel, legs: LegGeometry) -> None:
        self._sensors, self._mass_model = sensors, mass_model
        self._lowest = _LOWEST * scale_of(legs)
        toe, self._heel, outer, inner = legs.sole_size
        low, high = ((-self._heel, -inner), (-self._heel, -outer)), ((toe, outer), (toe, inner))
        self._low, self._high = np.array(low), np.array(high)
        self._speed = np.zeros((2, 3))
        self._felt = False
        self.axes: NDArray[np.float64] = np.eye(3)
        """Forward, left and up in the torso's frame, Shape (3, 3)."""
        self.soles: NDArray[np.float64] = np.zeros((2, 3))
        """Both soles, seen from the torso."""
        self.mass: NDArray[np.float64] = np.zeros((2, 3))
        """The centre of mass, seen from each sole."""
        self.dcm: NDArray[np.float64] = np.zeros((2, 2))
        """The DCM on the ground, seen from each sole."""
        self.omega = 6.0
        """How fast the body falls [1/s]: what the DCM is away from where it rests grows by that."""

    @property
    def ahead(self) -> float:
        """How far the centre of mass is in front of the ankles [m]."""
        return float(self.mass[:, 0].mean())

    @property
    def behind_heels(self) -> float:
        """How far the DCM is behind the rear edge of the feet [m], negative above them."""
        return float(-self._heel - self.dcm[:, 0].max())

    @property
    def beyond(self) -> tuple[float, float, float, float]:
        """How far the DCM is beyond front, rear, left and right edge of both feet together [m], negative inside."""
        low, high = self._low - self.dcm, self._high - self.dcm
        front, left = -high.max(axis=0)
        rear, right = low.min(axis=0)
        return float(front), float(rear), float(left), float(right)

    @property
    def aside(self) -> float:
        """How far the DCM is to the left of the middle between the feet [m]."""
        return float(self.dcm[:, 1].mean())

    @property
    def far(self) -> tuple[float, float]:
        """How far the DCM is from left and right ankle [m]."""
        left, right = self.dcm.tolist()
        return hypot(*left), hypot(*right)

    def feel(self) -> None:
        """Take note of this control period."""
        x, y, z = self._sensors.up
        level = hypot(y, z)
        self.axes = np.array(((level, -x * y / level, -x * z / level), (0.0, z / level, -y / level), (x, y, z)))
        com, soles = self._mass_model.pose(self._sensors.angles)
        self.soles = soles @ self.axes.T
        here = (com - soles) @ self.axes.T
        before = self.mass if self._felt else here
        self._speed = _SMOOTHING * self._speed + (1 - _SMOOTHING) * (here - before) / CONTROL_PERIOD
        self.mass, self._felt = here, True
        self.omega = sqrt(GRAVITY / max(float(here[:, 2].max()), self._lowest))
        self.dcm = here[:, :2] + self._speed[:, :2] / self.omega
