"""The way to a place, one walk at a time: turn towards it, walk up to it, turn as one stands there."""

from collections.abc import Mapping
from math import atan2, ceil, cos, hypot, sin

from lumen.language.commands import Walk
from lumen.language.hall_places import HallPlace
from lumen.motion.dead_reckoning import turned
from lumen.ports import Whereabouts

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
