"""What torque a motor has left at the speed it turns at."""

import numpy as np
from numpy.typing import NDArray

from lumen.features.simulation.imperfections import NOMINAL_VOLTAGE
from lumen.features.simulation.world import World

_WITHOUT_BOUND = 1e9
"""The stall torque [N m] of a motor that names none; infinity times a speed of 0 would be no number."""


class MotorTorques:
    """The lines from stall torque to no-load speed of all motors.

    A motor whose actuator names no stall torque keeps its torque at every speed; so do all where they are not
    `falling`. `fastest`: no-load speeds [rad/s] at the battery's nominal voltage, Shape (motors,).
    """

    def __init__(self, world: World, fastest: NDArray[np.float64], *, falling: bool = True) -> None:
        self._world, self._fastest = world, fastest if falling else np.full(len(fastest), np.inf)
        given = world.model.actuator_user[world.actuators]
        stall = given[:, 0] if given.shape[1] else np.zeros(len(fastest))
        self._stall = np.where(stall > 0.0, stall, _WITHOUT_BOUND)

    def limit(self, allowed: NDArray[np.float64], volts: float) -> NDArray[np.float64]:
        """Least and greatest torque [N m], Shape (motors, 2): those `allowed`, or what `volts` give at this speed."""
        supply, limits = volts / NOMINAL_VOLTAGE, np.empty((len(self._stall), 2))
        turning = self._world.motor_speeds / self._fastest
        np.maximum(allowed[:, 0], -self._stall * np.maximum(supply + turning, 0.0), out=limits[:, 0])
        np.minimum(allowed[:, 1], self._stall * np.maximum(supply - turning, 0.0), out=limits[:, 1])
        return limits
