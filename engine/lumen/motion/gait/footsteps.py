"""Where the feet go."""

from collections.abc import Mapping, Sequence
from math import ceil, hypot
from typing import NamedTuple

from lumen.motion.gait.legs import Side, SoleSize, other, sign
from lumen.motion.gait.parameters import GaitParameters
from lumen.motion.gait.poses import Pose

Feet = Mapping[Side, Pose]
"""Both soles, below the ankles."""


class Footstep(NamedTuple):
    """That foot goes there."""

    side: Side
    pose: Pose


def middle(feet: Feet) -> Pose:
    """The pose between the feet: where the robot stands."""
    return feet["L"].toward(feet["R"], 0.5)


def beside(body: Pose, side: Side, pace: GaitParameters) -> Pose:
    """Where that foot belongs while the robot stands at `body`."""
    return body.then(Pose(0.0, sign(side) * pace.apart / 2, 0.0))


def footsteps(feet: Feet, goal: Pose, first: Side, pace: GaitParameters) -> list[Footstep]:
    """The steps from these feet until they stand side by side at `goal`; `first` begins, then they alternate.

    A step that goes ahead, aside and around at once goes less far each way.
    """
    here = middle(feet)
    way = goal.seen_from(here)
    count = max(1, ceil(hypot(way.x / pace.forward, way.y / pace.sideways, way.theta / pace.turn) - 1e-6))
    steps: list[Footstep] = []
    side, bearing, there = first, feet[other(first)], 0
    while there < 2 and len(steps) < 2 * count + 4:
        part = min(1.0, (len(steps) + 1) / count)
        wanted = beside(here.then(Pose(way.x * part, way.y * part, way.theta * part)), side, pace)
        step = Footstep(side, clear(wanted, side, bearing, pace))
        there = there + 1 if part == 1.0 and abs(step.pose.place - wanted.place) < 1e-6 else 0
        steps.append(step)
        side, bearing = other(side), step.pose
    return steps


def clear(foot: Pose, side: Side, bearing: Pose, pace: GaitParameters) -> Pose:
    """That place for a foot, or the nearest that neither touches the bearing foot nor strains the hips."""
    seen = foot.seen_from(bearing)
    out = sign(side) * min(max(sign(side) * seen.y, pace.narrowest), pace.widest)
    return bearing.then(Pose(seen.x, out, seen.theta))


def first_side(way: Pose) -> Side:
    """The foot to begin with: the one on the side that the way `way`, seen from the robot, leads to."""
    if abs(way.y) > 0.005:
        return "L" if way.y > 0 else "R"
    return "L" if way.theta >= 0 else "R"


def corners(step: Footstep, sole: SoleSize) -> Sequence[complex]:
    """The corners of a sole of that size on the ground, x + iy [m]."""
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
