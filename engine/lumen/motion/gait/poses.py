"""Where something stands on the ground and where it faces."""

from cmath import rect
from math import pi
from typing import NamedTuple


class Pose(NamedTuple):
    """A place [m] and a heading to the left of ahead [rad], in some frame: x forward, y left."""

    x: float = 0.0
    y: float = 0.0
    theta: float = 0.0

    @property
    def place(self) -> complex:
        """The ground as the complex plane, x + iy [m]: turning is a product there."""
        return complex(self.x, self.y)

    @property
    def ahead(self) -> complex:
        """The unit vector that it faces along."""
        return rect(1.0, self.theta)

    def then(self, other: "Pose") -> "Pose":
        """That pose, which is seen from this one, in this one's frame."""
        return pose(self.place + other.place * self.ahead, self.theta + other.theta)

    def seen_from(self, origin: "Pose") -> "Pose":
        """This pose in the frame of `origin`, which stands in the same frame as this; -pi < theta <= pi."""
        return pose((self.place - origin.place) * origin.ahead.conjugate(), wrap(self.theta - origin.theta))

    def toward(self, other: "Pose", part: float) -> "Pose":
        """The pose that part (0..1) of the straight way to another, turned the shorter way."""
        place = self.place + (other.place - self.place) * part
        return pose(place, self.theta + wrap(other.theta - self.theta) * part)


def pose(place: complex, theta: float) -> Pose:
    """The pose at a place of the complex plane."""
    return Pose(place.real, place.imag, theta)


def wrap(angle: float) -> float:
    """The same direction [rad] between -pi (excluded) and pi."""
    return pi - (pi - angle) % (2 * pi)
