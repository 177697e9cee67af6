"""Where a robot believes to be by adding up its steps, and its way to a place, one walk at a time."""

from collections.abc import Mapping
from math import atan2, ceil, cos, hypot, pi, sin, sqrt

from lumen.language.commands import Walk
from lumen.language.hall_places import HallPlace
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


NEAR, FACING = 0.05, 0.1
"""Nearer than this [m], [rad], by its odometry, the robot walks no further."""

ASIDE = 0.3
"""So near [m] it walks in any direction without turning first."""

LONGEST_LEG = 2.0
"""So far it walks ahead [m] before it looks where its steps have led it."""

SPARE_LEGS = 6
"""How many walks a way may take beside those it takes at least."""

LEAVING = 1.2
"""So many times as far as `within` the robot has left a place where it was: it sways, and must not come and go."""


def next_leg(here: Whereabouts, place: HallPlace) -> Walk | None:
    """The next walk from here to that place; None where the robot is there, as far as it can tell."""
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
    """After how many walks a robot that set out here should be there."""
    return SPARE_LEGS + 2 * ceil(distance_to(here, place) / LONGEST_LEG)


def distance_to(here: Whereabouts, place: HallPlace) -> float:
    """How far it is to that place [m]."""
    return hypot(place.x - here.x, place.y - here.y)


def place_at(here: Whereabouts, places: Mapping[str, HallPlace], before: str) -> str:
    """The name of the place where the robot is; empty where it is at none.

    Of several it is the nearest, but `before`, where it was, as long as it has not left that.
    """
    if before in places and distance_to(here, places[before]) <= LEAVING * places[before].within:
        return before
    reached = {name: d for name, place in places.items() if (d := distance_to(here, place)) <= place.within}
    return min(reached, key=lambda name: reached[name], default="")
