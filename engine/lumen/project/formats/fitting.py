"""Curves brought within what a body can do beyond the range of each joint: coupled ranges, curved ways, speeds."""

from bisect import bisect_left
from collections.abc import Iterable, Iterator
from math import degrees, inf

from lumen.language.motions import Interpolation, Keyframe, MotionDefinition
from lumen.language.robots import Body
from lumen.motion import bounds
from lumen.motion.limits import Excess, beyond_limits, overspeed
from lumen.project.formats.conversion_findings import ConversionFindings
from lumen.project.formats.joint_curves import CurvePoint, JointCurves

MAX_FITS = 50
"""How often a change may make another one necessary; each comes nearer to what the body can do."""

SAME_ANGLE = 1e-9
"""[rad]"""


def within_limits(curves: JointCurves, body: Body, findings: ConversionFindings) -> JointCurves:
    """The curves, cut where a joint would go too far beside another one, or on a curved way between two keys."""
    for _ in range(MAX_FITS):
        far = beyond_limits(_definition(curves), body)
        if not far:
            return curves
        changed = {joint: list(points) for joint, points in curves.items()}
        for excess in far:
            _cut(changed[excess.joint], excess, body, findings)
        curves = changed
    return curves


def too_fast(curves: JointCurves, body: Body) -> list[Excess]:
    """Where a joint would have to move faster than it can, one for each key that it can't reach in time."""
    return overspeed(_definition(curves), body)


def slowed(curves: JointCurves, body: Body) -> JointCurves:
    """The curves with as much more time, where a joint needs it, for all joints at once: they stay together."""
    for _ in range(MAX_FITS):
        fast = too_fast(curves, body)
        if not fast:
            break
        motion = bounds.slowed(_definition(curves), fast)
        curves = {
            joint: [
                point._replace(time=key.time, handle_in=key.handle_in, handle_out=key.handle_out)
                for point, key in zip(points, motion.tracks[joint], strict=True)
            ]
            for joint, points in curves.items()
        }
    return curves


def _cut(points: list[CurvePoint], excess: Excess, body: Body, findings: ConversionFindings) -> None:
    """Take an excess away: bring the key to the limit, or where only the way to it goes too far, level its handles."""
    i = bisect_left([point.time for point in points], excess.key.time)
    unit, factor = ("", 1.0) if excess.joint in body.hands else (" deg", degrees(1.0))
    wanted, limit = (f"{round(angle * factor, 2):g}{unit}" for angle in (excess.value, excess.limit))
    if excess.joint != _joint(excess) or i == len(points) or points[i].time != excess.key.time:
        near = points[min(i, len(points) - 1)]
        beside = f"at the angle that `{_joint(excess)}` has at {excess.key.time:g} s"
        findings.changed(near.place, f"`{excess.joint}` can't reach {wanted} {beside}: it goes to {limit}")
        points.insert(i, CurvePoint(excess.key.time, excess.limit, near.place, near.straight))
    elif abs(points[i].angle - excess.value) < SAME_ANGLE:
        others = [coupled.on for coupled in body.coupled if coupled.joint == excess.joint]
        beside = f" at the angle that `{others[0]}` has at that time" if others else ""
        findings.changed(points[i].place, f"`{excess.joint}` can't reach {wanted}{beside}: it goes to {limit}")
        points[i] = points[i]._replace(angle=excess.limit, handle_in=(0.0, 0.0), handle_out=(0.0, 0.0))
    else:
        findings.changed(
            points[i].place, f"`{excess.joint}` would reach {wanted} between two keys: its handles are left out"
        )
        points[i] = points[i]._replace(handle_in=(0.0, 0.0))
        if i:
            points[i - 1] = points[i - 1]._replace(handle_out=(0.0, 0.0))


def _joint(excess: Excess) -> str:
    """The joint that the key of an excess belongs to: in a coupled range it may be the other one's."""
    return str(excess.key.where[0])


def _definition(curves: JointCurves) -> MotionDefinition:
    tracks = {joint: tuple(_keys(joint, points)) for joint, points in curves.items()}
    return MotionDefinition("curves", max((keys[-1].time for keys in tracks.values()), default=inf), tracks)


def _keys(joint: str, points: Iterable[CurvePoint]) -> Iterator[Keyframe]:
    for point in points:
        how = Interpolation.LINEAR if point.straight else Interpolation.BEZIER
        yield Keyframe(point.time, point.angle, how, point.handle_in, point.handle_out, (joint,))
