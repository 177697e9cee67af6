"""Routes between postures."""

from collections.abc import Iterator

from lumen.language.motions import MotionDefinition
from lumen.language.robots import Body

UPRIGHT = ("Stand", "StandInit", "StandZero", "Crouch")
"""Postures on both feet that every biped may have."""

RESTFUL = ("Crouch", "Sit", "SitRelax", "LyingBack", "LyingBelly")
"""Postures that a robot keeps with its motors off."""

STRAIGHT_COST = 1.0
"""Cost of a straight way [s], comparable with the duration of a passage."""


def standing(body: Body) -> tuple[str, ...]:
    """Return the postures that straight ways connect: for a biped those on its feet, for other bodies all.

    A biped's additional postures count as such, unless a passage leads to them.
    """
    if not body.roles.base.row.legs:
        return tuple(body.postures)
    passed = {*RESTFUL, *(end for motion in body.passages for end in (motion.start, motion.end))}
    own = [name for name in body.postures if name not in passed and name not in UPRIGHT]
    return (*(name for name in UPRIGHT if name in body.postures), *own)


def lies(posture: str) -> bool:
    """Return whether the robot lies on its back or belly in a posture."""
    return posture.startswith("Lying")


def passage(body: Body, start: str, end: str) -> MotionDefinition | None:
    """Return the motion from one posture to its neighbour; None for a straight way."""
    return next((p for p in body.passages if (p.start, p.end) == (start, end)), None)


def route(body: Body, start: str, *goals: str) -> list[str] | None:
    """Return the postures after `start` on the quickest way to the nearest goal; None if no goal can be reached."""
    found: dict[str, list[str]] = {}
    ways: dict[str, tuple[float, list[str]]] = {start: (0.0, [])}
    while ways:
        # Dijkstra's algorithm: the cheapest open posture can't be reached more cheaply later
        here = min(ways, key=lambda name: ways[name][0])
        cost, path = ways.pop(here)
        if here in goals:
            return path
        found[here] = path
        for name, more in _neighbours(body, here):
            if name not in found and cost + more < ways.get(name, (float("inf"), []))[0]:
                ways[name] = cost + more, [*path, name]
    return None


def _neighbours(body: Body, posture: str) -> Iterator[tuple[str, float]]:
    if posture in (upright := standing(body)):
        yield from ((name, STRAIGHT_COST) for name in upright if name != posture)
    yield from ((p.end, p.duration) for p in body.passages if p.start == posture)
