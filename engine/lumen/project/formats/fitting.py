"""Fit curves to a body's limits other than the range of a joint at a key: coupled ranges, curved paths, speeds."""

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
"""The maximum number of passes: one change may require another, but each pass comes nearer to the limits."""

SAME_ANGLE = 1e-9
"""The angle below which two angles count as equal [rad]."""


def within_limits(curves: JointCurves, body: Body, findings: ConversionFindings) -> JointCurves:
    """Return the curves, cut wherever a joint would leave its coupled range, or its range between two keys.

    Each cut is reported in `findings`. After `MAX_FITS` passes the curves are returned as they are.
    """
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
    """Return the keys that a joint can't reach in time at its maximum speed, one excess for each."""
    return overspeed(_definition(curves), body)


def slowed(curves: JointCurves, body: Body) -> JointCurves:
    """Return the curves with more time before keys that are too fast; all joints are delayed alike, to stay in step."""
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
    """Remove an excess: move the key to the limit, or level its handles if only the path to it goes too far."""
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
    """Return the joint to which the key of an excess belongs; in a coupled range, that may be the other joint."""
    return str(excess.key.where[0])


def _definition(curves: JointCurves) -> MotionDefinition:
    tracks = {joint: tuple(_keys(joint, points)) for joint, points in curves.items()}
    return MotionDefinition("curves", max((keys[-1].time for keys in tracks.values()), default=inf), tracks)


def _keys(joint: str, points: Iterable[CurvePoint]) -> Iterator[Keyframe]:
    for point in points:
        how = Interpolation.LINEAR if point.straight else Interpolation.BEZIER
        yield Keyframe(point.time, point.angle, how, point.handle_in, point.handle_out, (joint,))
