"""A robot's estimate of its place, by adding up its steps, and its way to another place, one walk at a time."""

from collections.abc import Mapping
from math import atan2, ceil, cos, hypot, pi, sin, sqrt

from lumen.language.commands import Walk
from lumen.language.hall_places import HallPlace
from lumen.ports import Whereabouts

PLACE_PER_METRE, PLACE_PER_RADIAN = 0.03, 0.006
"""The error of the place [m] after 1 m straight ahead, and after a turn of 1 rad."""

HEADING_PER_METRE, HEADING_PER_RADIAN = 0.02, 0.022
"""The error of the heading [rad] after 1 m straight ahead, and after a turn of 1 rad.

All four exceed the error of every simulated robot, of any weight, on any floor (docs/decisions/034).
"""


class DeadReckoning:
    """The robot's place and heading in the frame of its start, updated by `follow`.

    `slid` [m] is the distance that it may have moved without walking; it is added in full. Errors of walking are
    independent of each other: those of the heading grow with the square root of the distance walked, those of the place
    faster.
    """

    def __init__(self) -> None:
        self.x, self.y, self.theta = 0.0, 0.0, 0.0
        self.slid = 0.0
        self._place, self._both, self._heading = 0.0, 0.0, 0.0

    @property
    def whereabouts(self) -> Whereabouts:
        """The estimated place and heading, and the possible error of the place [m]."""
        return Whereabouts(self.x, self.y, self.theta, self.slid + sqrt(self._place))

    def follow(self, x: float, y: float, theta: float) -> None:
        """Update the estimate: the robot has walked straight from its last place to this one."""
        way, turn = hypot(x - self.x, y - self.y), abs(turned(self.theta, theta))
        if not (way or turn):
            return
        self._heading += HEADING_PER_METRE**2 * way + HEADING_PER_RADIAN**2 * turn
        self._place += way * (2 * self._both + self._heading * way + PLACE_PER_METRE**2) + PLACE_PER_RADIAN**2 * turn
        self._both += self._heading * way
        self.x, self.y, self.theta = x, y, theta


def turned(before: float, after: float) -> float:
    """Return the shorter turn from one heading to another, positive to the left [rad]."""
    return pi - (pi - after + before) % (2 * pi)


def beyond(here: Whereabouts, x: float, y: float, theta: float) -> tuple[float, float, float]:
    """Return the pose reached from `here` by moving by x, y and theta, which are in the frame of `here`."""
    c, s = cos(here.theta), sin(here.theta)
    return here.x + x * c - y * s, here.y + x * s + y * c, turned(0.0, here.theta + theta)


NEAR, FACING = 0.05, 0.1
"""The accepted distance and turn from the goal, by odometry [m], [rad]."""

ASIDE = 0.3
"""The distance below which the robot walks in any direction without turning first [m]."""

LONGEST_LEG = 2.0
"""The longest straight walk [m], before the robot checks its position again."""

SPARE_LEGS = 6
"""The number of walks that a way may use in addition to the necessary ones."""

LEAVING = 1.2
"""The robot leaves its place at this multiple of `within`: hysteresis, because its position sways."""


def next_leg(here: Whereabouts, place: HallPlace) -> Walk | None:
    """Return the next walk towards that place; None if the robot is there by its estimate."""
    dx, dy = place.x - here.x, place.y - here.y
    distance, c, s = hypot(dx, dy), cos(here.theta), sin(here.theta)
    ahead, left = dx * c + dy * s, dy * c - dx * s
    turn = 0.0 if place.heading is None else turned(here.theta, place.heading)
    if distance <= min(NEAR, place.within):
        return Walk(theta=turn) if abs(turn) > FACING else None
    if distance <= ASIDE:
        return Walk(ahead, left, turn)
    bearing = atan2(left, ahead)
    if abs(bearing) > FACING:
        return Walk(theta=bearing)
    part = min(1.0, LONGEST_LEG / distance)
    return Walk(ahead * part, left * part)


def most_legs(here: Whereabouts, place: HallPlace) -> int:
    """Return the maximum number of walks from `here` to `place`; a robot that needs more has failed."""
    return SPARE_LEGS + 2 * ceil(distance_to(here, place) / LONGEST_LEG)


def distance_to(here: Whereabouts, place: HallPlace) -> float:
    """Return the distance to that place [m]."""
    return hypot(place.x - here.x, place.y - here.y)


def place_at(here: Whereabouts, places: Mapping[str, HallPlace], before: str) -> str:
    """Return the name of the robot's place; empty if it is not at any of them.

    Of several places the nearest counts; but `before`, the robot's last place, stays as long as the robot has not left
    it.
    """
    if before in places and distance_to(here, places[before]) <= LEAVING * places[before].within:
        return before
    reached = {name: d for name, place in places.items() if (d := distance_to(here, place)) <= place.within}
    return min(reached, key=lambda name: reached[name], default="")
