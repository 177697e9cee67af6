"""Where the feet go: for a walk to a goal, and while the robot walks on (NAOqi's `move`)."""

from collections.abc import Mapping, Sequence
from math import ceil, hypot
from typing import Literal, NamedTuple

from lumen.language.robots import Body
from lumen.motion.gait.legs import Side, SoleSize, other, sign
from lumen.motion.gait.parameters import GaitParameters, paces_without_legs
from lumen.motion.gait.poses import Pose

Feet = Mapping[Side, Pose]
"""The poses of both soles, below the ankles."""


class Footstep(NamedTuple):
    """A step: the foot `side` moves to `pose`."""

    side: Side
    pose: Pose


def middle(feet: Feet) -> Pose:
    """Return the pose midway between the feet, which is the robot's pose."""
    return feet["L"].toward(feet["R"], 0.5)


def beside(body: Pose, side: Side, pace: GaitParameters) -> Pose:
    """Return the pose of the foot on that side, for a standing robot whose pose is `body`."""
    return body.then(Pose(0.0, sign(side) * pace.apart / 2, 0.0))


def footsteps(feet: Feet, goal: Pose, first: Side, pace: GaitParameters) -> list[Footstep]:
    """Return the steps from these feet until they are side by side at `goal`; `first` begins, then they alternate.

    A step that combines forward, sideways and turning motion is shorter in each of them.
    """
    here = middle(feet)
    way = goal.seen_from(here)
    count = max(1, ceil(hypot(way.x / pace.forward, way.y / pace.sideways, way.theta / pace.turn) - 1e-6))
    steps: list[Footstep] = []
    side, bearing, there = first, feet[other(first)], 0
    # Both feet must reach the goal; the bound ends a walk in which one never does
    while there < 2 and len(steps) < 2 * count + 4:
        part = min(1.0, (len(steps) + 1) / count)
        wanted = beside(here.then(Pose(way.x * part, way.y * part, way.theta * part)), side, pace)
        step = Footstep(side, clear(wanted, side, bearing, pace))
        there = there + 1 if part == 1.0 and abs(step.pose.place - wanted.place) < 1e-6 else 0
        steps.append(step)
        side, bearing = other(side), step.pose
    return steps


def clear(foot: Pose, side: Side, bearing: Pose, pace: GaitParameters) -> Pose:
    """Return the wanted pose, or the nearest one that neither touches the bearing foot nor overstretches the hips."""
    seen = foot.seen_from(bearing)
    out = sign(side) * min(max(sign(side) * seen.y, pace.narrowest), pace.widest)
    return bearing.then(Pose(seen.x, out, seen.theta))


def first_side(way: Pose) -> Side:
    """Return the first foot to move: that on the side of the goal; `way` is the goal relative to the robot."""
    if abs(way.y) > 0.005:
        return "L" if way.y > 0 else "R"
    return "L" if way.theta >= 0 else "R"


def corners(step: Footstep, sole: SoleSize) -> Sequence[complex]:
    """Return the four corners of a sole of that size on the ground, x + iy [m]."""
    s, foot = sign(step.side), step.pose
    return [
        foot.place + complex(ahead, s * out) * foot.ahead
        for ahead, out in (
            (sole.toe, sole.outer),
            (sole.toe, -sole.inner),
            (-sole.heel, sole.outer),
            (-sole.heel, -sole.inner),
        )
    ]


MOST_CHANGE = 0.3
"""Greatest change of velocity per step, relative to the pace's maximum: a sudden reversal makes the robot stumble."""


class Velocity(NamedTuple):
    """A velocity relative to the robot: forward and left [m/s], turning left [rad/s]; zero means to stand."""

    x: float = 0.0
    y: float = 0.0
    theta: float = 0.0

    def within(self, pace: GaitParameters) -> "Velocity":
        """Return the velocity, scaled down to the maximum of the pace if it is higher."""
        haste = self._haste(pace)
        return Velocity(*(part / max(1.0, haste) for part in self))

    def toward(self, goal: "Velocity", pace: GaitParameters) -> "Velocity":
        """Return the velocity one step later, changed towards `goal`."""
        wanted = goal.within(pace)
        change = Velocity(*(there - here for here, there in zip(self, wanted, strict=True)))
        part = MOST_CHANGE / max(MOST_CHANGE, change._haste(pace))
        return Velocity(*(here + part * more for here, more in zip(self, change, strict=True)))

    def _haste(self, pace: GaitParameters) -> float:
        """Return the speed relative to the maximum of the pace."""
        return hypot(*(part / limit for part, limit in zip(self, fastest(pace), strict=True)))


def fastest(pace: GaitParameters) -> Velocity:
    """Return the maximum velocities forward, sideways and turning at that pace, each without the others."""
    step = pace.double + pace.single
    aside = min(pace.sideways, (pace.widest - pace.apart) / 2)
    return Velocity(pace.forward / step, aside / step, pace.turn / step)


def fastest_of(body: Body, pace: Literal["usual", "brisk"]) -> Velocity:
    """Return the maximum velocities of a body according to its description: those of its wheels, else of the pace."""
    base = body.roles.base
    if base.row.drives:
        return Velocity(base.speed, 0.0, base.turn)
    paces = paces_without_legs(body.gait)
    return fastest(paces.brisk if pace == "brisk" else paces.usual)


def strides(feet: Feet, velocity: Velocity, first: Side, pace: GaitParameters, count: int) -> list[Footstep]:
    """Return the next `count` steps at that velocity; `first` begins, then the feet alternate.

    Each step starts from the correct place of the bearing foot, so that the error of one step is not repeated. In
    sideways motion the foot on that side covers the distance of two steps and the other one follows, because the feet
    must not touch.
    """
    speed, time = velocity.within(pace), pace.double + pace.single
    steps: list[Footstep] = []
    side, bearing = first, feet[other(first)]
    for _ in range(count):
        aside = 2 * speed.y * time if sign(side) * speed.y > 0 else 0.0
        here = bearing.then(Pose(0.0, sign(side) * pace.apart / 2))
        there = here.then(Pose(speed.x * time, aside, speed.theta * time))
        step = Footstep(side, clear(beside(there, side, pace), side, bearing, pace))
        steps.append(step)
        side, bearing = other(side), step.pose
    return steps
