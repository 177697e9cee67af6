"""Steadies the robot on its feet."""

import numpy as np

from lumen.robots.simulation.joint_envelope import JointVector
from lumen.robots.simulation.motors import Motors

BALANCE_GAIN = 0.05
"""Ankle angle for each unit of the torso's turning speed [rad per rad/s]: the toes press where it falls to."""

MAX_TRIM = 0.15
_SMOOTHING = 0.5


class BalanceController:
    """Turns what the gyrometer feels into a trim of both ankles, but of the foot that is `lifted` (`L` or `R`)."""

    def __init__(self, motors: Motors) -> None:
        self._ankles = [[(s, motors.index[s + name]) for s in "LR"] for name in ("AnkleRoll", "AnklePitch")]
        self._trim = np.zeros(len(motors.names))
        self._felt = [0.0, 0.0]
        self.lifted: str | None = None

    def trim(self, gyro: tuple[float, float]) -> JointVector:
        """What to add to the joints' goals [rad] while the torso rolls and pitches like this [rad/s].

        Valid until called again; `lifted` is for this once.
        """
        for axis, rate in enumerate(gyro):
            felt = self._felt[axis] = _SMOOTHING * self._felt[axis] + (1 - _SMOOTHING) * rate
            angle = min(max(BALANCE_GAIN * felt, -MAX_TRIM), MAX_TRIM)
            for side, i in self._ankles[axis]:
                self._trim[i] = 0.0 if side == self.lifted else angle
        self.lifted = None
        return self._trim
