"""Steadies the robot on its feet."""

import numpy as np

from lumen.robots.simulation.limits import Angles
from lumen.robots.simulation.motors import Motors
from lumen.robots.simulation.world import World

GAIN = 0.05
"""Ankle angle for each unit of the torso's turning speed [rad per rad/s]: the toes press where it falls to."""

MOST = 0.15
_SMOOTHING = 0.5


class Balance:
    """Turns what the gyrometer feels into a trim of both ankles."""

    def __init__(self, motors: Motors) -> None:
        names = ("LAnkleRoll", "RAnkleRoll", "LAnklePitch", "RAnklePitch")
        self._ankles = [motors.index[name] for name in names]
        self._trim = np.zeros(len(motors.names))
        self._felt = [0.0, 0.0]

    def trim(self, world: World) -> Angles:
        """What to add to the joints' goals now [rad]; valid until the next call."""
        for axis, rate in enumerate(world.gyro):
            felt = self._felt[axis] = _SMOOTHING * self._felt[axis] + (1 - _SMOOTHING) * rate
            angle = min(max(GAIN * felt, -MOST), MOST)
            for i in self._ankles[2 * axis : 2 * axis + 2]:
                self._trim[i] = angle
        return self._trim
