"""Where a robot believes to be by adding up its steps, and how far from there it may really be."""

from math import cos, hypot, pi, sin, sqrt

from lumen.ports import Whereabouts

PLACE_PER_METRE, PLACE_PER_RADIAN = 0.03, 0.006
"""How far off a robot may be after a metre straight ahead, and after a turn of 1 rad [m]."""

HEADING_PER_METRE, HEADING_PER_RADIAN = 0.02, 0.022
"""How far from where it believes it may face after these [rad].

All four are chosen so that no simulated robot was farther off, of any weight, on any floor (docs/decisions/034).
"""


class DeadReckoning:
    """The robot's place and heading in the frame of its start, moved on with `follow`.

    `slid` [m] is how far it may have moved without walking, which is added as it is. What walking adds are errors that
    know nothing of each other: they grow with the root of the way, and those of the heading with the way once more.
    """

    def __init__(self) -> None:
        self.x, self.y, self.theta = 0.0, 0.0, 0.0
        self.slid = 0.0
        self._place, self._both, self._heading = 0.0, 0.0, 0.0

    @property
    def whereabouts(self) -> Whereabouts:
        return Whereabouts(self.x, self.y, self.theta, self.slid + sqrt(self._place))

    def follow(self, x: float, y: float, theta: float) -> None:
        """The robot has come there by walking, straight from where it was."""
        way, turn = hypot(x - self.x, y - self.y), abs(turned(self.theta, theta))
        if not (way or turn):
            return
        self._heading += HEADING_PER_METRE**2 * way + HEADING_PER_RADIAN**2 * turn
        self._place += way * (2 * self._both + self._heading * way + PLACE_PER_METRE**2) + PLACE_PER_RADIAN**2 * turn
        self._both += self._heading * way
        self.x, self.y, self.theta = x, y, theta


def turned(before: float, after: float) -> float:
    """How far one turns to the left from one heading to another, the shorter way [rad]."""
    return pi - (pi - after + before) % (2 * pi)


def beyond(here: Whereabouts, x: float, y: float, theta: float) -> tuple[float, float, float]:
    """Where one stands who goes by x, y and theta from there, all as seen from there."""
    c, s = cos(here.theta), sin(here.theta)
    return here.x + x * c - y * s, here.y + x * s + y * c, turned(0.0, here.theta + theta)
