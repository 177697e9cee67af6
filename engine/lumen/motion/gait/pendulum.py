"""The linear inverted pendulum: how the body falls, and how it must begin to fall to end at a given point.

The divergent component of motion (DCM) is the centre of mass plus its velocity divided by omega. The body falls away
from the point it rests on (ZMP), towards the DCM: Englsberger, Ott and Albu-Schäffer, "Three-dimensional bipedal
walking control using divergent component of motion", 2013. Points are x + iy [m].
"""

from collections.abc import Sequence
from math import exp, sqrt

GRAVITY = 9.81


class Pendulum:
    """A centre of mass at a constant height [m], in ticks of `dt` [s]."""

    def __init__(self, height: float, dt: float) -> None:
        self.factor = exp(-sqrt(GRAVITY / height) * dt)

    def backward(self, zmp: Sequence[complex], end: complex) -> complex:
        """Return the DCM from which the body reaches the DCM `end` after one tick on each of these points."""
        for point in reversed(zmp):
            end = point + (end - point) * self.factor
        return end

    def shift(self, dcm: complex, zmp: Sequence[complex], end: complex) -> complex:
        """Return the shift of all these points with which the body gets from the DCM `dcm` to `end`."""
        return (dcm - self.backward(zmp, end)) / (1 - self.factor ** len(zmp))

    def fall(self, com: complex, dcm: complex, zmp: complex) -> tuple[complex, complex]:
        """Return the centre of mass and the DCM one tick later."""
        dcm = zmp + (dcm - zmp) / self.factor
        return com + (dcm - com) * (1 - self.factor), dcm
