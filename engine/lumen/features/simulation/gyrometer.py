"""What the simulated gyrometer tells of how fast the torso turns."""

from math import exp

import numpy as np
from numpy.typing import NDArray

from lumen.features.simulation.gyro_calibration import GyroCalibration
from lumen.features.simulation.imperfections import (
    GYRO_BIAS,
    GYRO_DRIFT,
    GYRO_NOISE,
    GYRO_RESIDUE,
    WARMING,
    WARMING_TIME,
)
from lumen.features.simulation.settings import Imperfections
from lumen.features.simulation.world import CONTROL_PERIOD


class Gyrometer:
    """Rates with noise and a bias that grows as the robot warms up, less the bias that it has learned at rest.

    The robot has rested before the run began: what it does not know of the bias then is a residue. Each robot's seed
    has its own bias.
    """

    def __init__(self, lacking: Imperfections, seed: int) -> None:
        draw = np.random.default_rng((seed, 1))
        whole = float(lacking.gyro_bias)
        self._bias = whole * draw.uniform(-GYRO_BIAS, GYRO_BIAS, 3)
        self._drift = whole * draw.uniform(-GYRO_DRIFT, GYRO_DRIFT, 3)
        self._noise = GYRO_NOISE if lacking.noise else 0.0
        self._calibration = GyroCalibration(self._bias + whole * draw.normal(0.0, GYRO_RESIDUE, 3))
        self._periods = 0

    def feel(self, rates: tuple[float, float, float], errors: NDArray[np.float64], *, at_rest: bool) -> list[float]:
        """How fast it believes to turn [rad/s], a control period later; `errors` are draws of a normal distribution."""
        self._periods += 1
        warmer = WARMING * (1.0 - exp(-self._periods * CONTROL_PERIOD / WARMING_TIME))
        told: NDArray[np.float64] = self._bias + warmer * self._drift + rates + self._noise * errors
        self._calibration.feel(told, at_rest=at_rest)
        believed: list[float] = (told - self._calibration.bias).tolist()
        return believed
