"""Where the robot falls to, by what it measures of itself."""

from math import hypot, sqrt

import numpy as np

from lumen.interpreters.gait.footsteps import HEEL
from lumen.interpreters.gait.pendulum import GRAVITY
from lumen.robots.simulation.mass_model import MassModel
from lumen.robots.simulation.sensors import BodySensors
from lumen.robots.simulation.world import CONTROL_PERIOD

_SMOOTHING = 0.65
_LOWEST = 0.15


class FallingSense:
    """The centre of mass and its divergent component of motion (DCM), forward of the point between the ankles.

    Level with the ground, along the torso's heading. From encoders, the inertial unit and the published masses alone:
    what the robot carries, and how it was built, it does not know. The DCM is where the weight would have to rest for
    the body to come to a halt there: the capture point of Pratt and others, "Capture point: a step toward humanoid push
    recovery", 2006.
    """

    def __init__(self, sensors: BodySensors, mass_model: MassModel) -> None:
        self._sensors, self._mass_model = sensors, mass_model
        self._speed = 0.0
        self._felt = False
        self.ahead = 0.0
        """How far the centre of mass is in front of the ankles [m]."""
        self.behind_heels = -HEEL
        """How far the DCM is behind the rear edge of the feet [m], negative above them."""

    def feel(self) -> None:
        """Take note of this control period."""
        x, y, z = self._sensors.up
        com, soles = self._mass_model.pose(self._sensors.angles)
        between, up = (soles[0] + soles[1]) / 2, np.array((x, y, z))
        level = hypot(y, z)
        ahead = np.array((level, -x * y / level, -x * z / level))
        here = float(ahead @ (com - between))
        before = self.ahead if self._felt else here
        self._speed = _SMOOTHING * self._speed + (1 - _SMOOTHING) * (here - before) / CONTROL_PERIOD
        self.ahead, self._felt = here, True
        height = max(float(up @ (com - between)), _LOWEST)
        heels = -HEEL - abs(float(ahead @ (soles[0] - soles[1]))) / 2
        self.behind_heels = heels - (here + self._speed / sqrt(GRAVITY / height))
