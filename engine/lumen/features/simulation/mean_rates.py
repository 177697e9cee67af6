"""How fast a gyrometer turns."""

import numpy as np
from numpy.typing import NDArray

from lumen.features.simulation.physics import mujoco
from lumen.features.simulation.world import CONTROL_PERIOD


class MeanRates:
    """How fast its axes have turned [rad/s] on average, about themselves, in the control period that ends.

    A gyrometer filters, and so tells the mean. Who reads an instant of each period has a robot turn 3 % too slowly:
    motors that are told where to go once in a period jerk with it. `axes` (9,) change with the world; without any
    nothing ever turns.
    """

    def __init__(self, axes: NDArray[np.float64] | None) -> None:
        self._axes = axes
        self._before, self._now, self._turned = np.zeros(4), np.zeros(4), np.zeros(3)
        self._begun = False

    def feel(self) -> tuple[float, float, float]:
        """Roll to the right, pitch forward, turn to the left; nothing in the first period."""
        if self._axes is not None:
            self._before, self._now = self._now, self._before
            mujoco.mju_mat2Quat(self._now, self._axes)
            if self._begun:
                mujoco.mju_subQuat(self._turned, self._now, self._before)
            self._begun = True
        roll, pitch, yaw = (self._turned / CONTROL_PERIOD).tolist()
        return roll, pitch, yaw
