"""The limits of a body that a motion exceeds."""

from collections.abc import Iterator, Mapping
from itertools import pairwise
from math import inf
from typing import NamedTuple

from lumen.language.motions import Keyframe, MotionDefinition
from lumen.language.robots import Body, CoupledLimit
from lumen.motion.trajectories import JointTrack, Trajectory

LIMIT_SLACK = 1e-6
"""The accepted excess over an angle limit [rad], and over a speed limit, relative: numbers in files are rounded."""

COUPLED_TOLERANCE = 1e-3
"""The accepted excess over a coupled limit [rad]: the published tables deviate from the joint limits by as much."""


class Excess(NamedTuple):
    """A value beyond a joint's limit."""

    joint: str
    key: Keyframe
    """The keyframe on the way to which the joint exceeds its limit."""
    value: float
    """The angle [rad] or the speed [rad/s] that the joint would reach."""
    limit: float
    """The limit of that angle or speed."""


def beyond_limits(motion: MotionDefinition, body: Body, trajectory: Trajectory | None = None) -> list[Excess]:
    """Return the excesses over limits [rad], coupled ones included, at keys or on Bezier curves between them.

    `trajectory` is `Trajectory(motion)`, for callers that have it already.
    """
    tracks = {track.joint: track for track in (trajectory or Trajectory(motion)).tracks}
    coupled = (excess for limit in body.coupled for excess in _beyond_coupled(motion, limit, tracks))
    return [*_beyond(motion, body, tracks), *coupled]


def overspeed(motion: MotionDefinition, body: Body, trajectory: Trajectory | None = None) -> list[Excess]:
    """Return the excesses over maximum speeds [rad/s] of a motion that begins in its start posture.

    There is one entry for each key that can't be reached in time. Without a start posture the way to the first key is
    not checked. `trajectory` is `Trajectory(motion)`, for callers that have it already.
    """
    found = []
    for track in (trajectory or Trajectory(motion)).tracks:
        limit = body.joints[track.joint].speed if track.joint in body.joints else inf
        for key, segment in zip(motion.tracks[track.joint], track.segments, strict=True):
            if (speed := segment.peak_speed()) > limit * (1 + LIMIT_SLACK):
                found.append(Excess(track.joint, key, speed, limit))
    return found


def coupled_range(limit: CoupledLimit, on: float) -> tuple[float, float]:
    """Return the range of `limit.joint` [rad] while `limit.on` is at `on` [rad]."""
    rows = limit.rows
    if on <= rows[0][0]:
        return rows[0][1:]
    for (x0, low0, high0), (x1, low1, high1) in pairwise(rows):
        if on <= x1:
            w = (on - x0) / (x1 - x0) if x1 > x0 else 1.0
            return low0 + w * (low1 - low0), high0 + w * (high1 - high0)
    return rows[-1][1:]


def _beyond(motion: MotionDefinition, body: Body, tracks: Mapping[str, JointTrack]) -> Iterator[Excess]:
    for track in tracks.values():
        if joint := body.joints.get(track.joint):
            for key, segment in zip(motion.tracks[track.joint], track.segments, strict=True):
                low, high = segment.extremes()
                if min(low, key.angle) < joint.minimum - LIMIT_SLACK:
                    yield Excess(track.joint, key, min(low, key.angle), joint.minimum)
                elif max(high, key.angle) > joint.maximum + LIMIT_SLACK:
                    yield Excess(track.joint, key, max(high, key.angle), joint.maximum)


def _beyond_coupled(
    motion: MotionDefinition, limit: CoupledLimit, tracks: Mapping[str, JointTrack]
) -> Iterator[Excess]:
    """Yield excesses at the keys of both joints, because a movement of either may close the range of the other."""
    if limit.on not in motion.tracks or limit.joint not in motion.tracks:
        return
    keys = {key.time: key for joint in (limit.on, limit.joint) for key in motion.tracks[joint]}
    for time, key in sorted(keys.items()):
        angle = tracks[limit.joint].at(time)
        low, high = coupled_range(limit, tracks[limit.on].at(time))
        if angle < low - COUPLED_TOLERANCE:
            yield Excess(limit.joint, key, angle, low)
        elif angle > high + COUPLED_TOLERANCE:
            yield Excess(limit.joint, key, angle, high)
