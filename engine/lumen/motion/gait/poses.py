"""Places and headings on the ground."""

from cmath import rect
from math import pi
from typing import NamedTuple


class Pose(NamedTuple):
    """A place [m] and a heading, positive to the left [rad]; in its frame x is forward and y is left."""

    x: float = 0.0
    y: float = 0.0
    theta: float = 0.0

    @property
    def place(self) -> complex:
        """The place as a complex number, x + iy [m], which a multiplication rotates."""
        return complex(self.x, self.y)

    @property
    def ahead(self) -> complex:
        """The unit vector of the heading, as a complex number."""
        return rect(1.0, self.theta)

    def then(self, other: "Pose") -> "Pose":
        """Return `other`, which is given relative to this pose, in the frame in which this pose is given."""
        return pose(self.place + other.place * self.ahead, self.theta + other.theta)

    def seen_from(self, origin: "Pose") -> "Pose":
        """Return this pose relative to `origin`, which is in the same frame; -pi < theta <= pi."""
        return pose((self.place - origin.place) * origin.ahead.conjugate(), wrap(self.theta - origin.theta))

    def toward(self, other: "Pose", part: float) -> "Pose":
        """Return the pose at `part` (0..1) of the straight way to another pose, turned the shorter way."""
        place = self.place + (other.place - self.place) * part
        return pose(place, self.theta + wrap(other.theta - self.theta) * part)


def pose(place: complex, theta: float) -> Pose:
    """Return the pose at a place x + iy [m] with the heading `theta` [rad]."""
    return Pose(place.real, place.imag, theta)


def wrap(angle: float) -> float:
    """Return the equivalent angle in (-pi, pi] [rad]."""
    return pi - (pi - angle) % (2 * pi)
