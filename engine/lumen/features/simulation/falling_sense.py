"""The direction in which the robot is falling, estimated from its own sensors."""

from math import hypot, sqrt

import numpy as np
from numpy.typing import NDArray

from lumen.features.simulation.mass_model import MassModel
from lumen.features.simulation.sensors import BodySensors
from lumen.features.simulation.world import CONTROL_PERIOD
from lumen.motion.gait import LegGeometry
from lumen.motion.gait.parameters import scale_of
from lumen.motion.gait.pendulum import GRAVITY

_SMOOTHING = 0.65
_LOWEST = 0.15
"""The least height of the centre of mass that is assumed [m], for legs as long as those that the paces were tuned with.
"""


class FallingSense:
    """The centre of mass and its divergent component of motion (DCM), as seen from the feet.

    Axes are level with the ground: forward along the torso's heading, left, up [m]. The sources are encoders, the
    inertial unit and the published masses; a load or differences in build are unknown to it. The DCM is the point where
    the weight would have to rest for the body to come to a halt there: the capture point of Pratt and others, "Capture
    point: a step toward humanoid push recovery", 2006. In arrays with two rows the first is the left foot's.
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
        """Both soles, seen from the torso."""
        self.mass: NDArray[np.float64] = np.zeros((2, 3))
        """The centre of mass, seen from each sole."""
        self.dcm: NDArray[np.float64] = np.zeros((2, 2))
        """The DCM on the ground, seen from each sole."""
        self.omega = 6.0
        """The rate at which the DCM's distance from its resting point grows [1/s]."""

    @property
    def ahead(self) -> float:
        """The distance of the centre of mass in front of the ankles [m]."""
        return self._ahead

    @property
    def behind_heels(self) -> float:
        """The distance of the DCM behind the rear edge of the feet [m], negative above them."""
        return -self._sole[1] - max(self._left[0], self._right[0])

    @property
    def beyond(self) -> tuple[float, float, float, float]:
        """The distances of the DCM beyond the front, rear, left and right edge of both feet together [m], negative
        inside.
        """
        toe, heel, outer, inner = self._sole
        (left_x, left_y), (right_x, right_y) = self._left, self._right
        ahead, behind = toe - min(left_x, right_x), -heel - max(left_x, right_x)
        return -ahead, behind, -max(outer - left_y, inner - right_y), min(-inner - left_y, -outer - right_y)

    @property
    def aside(self) -> float:
        """The distance of the DCM to the left of the middle between the feet [m]."""
        return (self._left[1] + self._right[1]) / 2

    @property
    def far(self) -> tuple[float, float]:
        """The distances of the DCM from the left and the right ankle [m]."""
        return hypot(*self._left), hypot(*self._right)

    def feel(self) -> None:
        """Update the estimate; call it once in each control period."""
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
