"""What a gyrometer tells while nothing turns, learned at rest."""

import numpy as np
from numpy.typing import NDArray

LEARNING_PERIODS = 1200
"""How many control periods at rest count."""

REST, REST_SPREAD = 10, 0.05
"""At rest what it tells hardly changes: by so much at most [rad/s], in so many control periods."""


class GyroCalibration:
    """Learns the gyrometer's `bias` [rad/s], Shape (3,), whenever the robot is at rest; begins with one known before.

    A robot that breathes and shifts its weight turns to and fro: over twelve seconds that is nothing.
    """

    def __init__(self, bias: NDArray[np.float64]) -> None:
        self.bias = bias
        self._told = np.full((REST, 3), np.inf)
        self._next = 0

    def feel(self, rates: NDArray[np.float64], *, at_rest: bool) -> None:
        """Take note of what it tells in a control period [rad/s]; `at_rest`: nothing moves the robot on purpose."""
        self._told[self._next] = rates if at_rest else np.inf
        self._next = (self._next + 1) % REST
        if at_rest and max((np.maximum.reduce(self._told) - np.minimum.reduce(self._told)).tolist()) < REST_SPREAD:
            self.bias = self.bias + (rates - self.bias) / LEARNING_PERIODS
