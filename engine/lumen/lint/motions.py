"""Checks the movement of motions between keys against the limits of the robot's joints."""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from functools import partial
from math import ceil

from lumen.language.diagnostics import ERROR, Code, NodePath
from lumen.language.motions import MotionDefinition
from lumen.language.robots import Body
from lumen.motion.limits import Excess, beyond_limits, overspeed
from lumen.motion.trajectories import Trajectory
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft
from lumen.project.memoization import memoize
from lumen.project.poses import ANGLE_OUT_OF_RANGE
from lumen.project.project_folders import PASSAGES
from lumen.project.units import JointUnits, joint_units

TOO_FAST = Code("too-fast", "motions", ERROR, "a joint would have to move faster than it can")


"""Gestures that are too fast also have this code."""


def check(draft: ProjectDraft) -> None:
    """Report joints that would be too fast, or beyond their limits between two keys or because of another joint."""
    if draft.body is None:
        return
    body = replace(draft.body, passages=())
    motions = [("motions", motion) for motion in draft.motions.values()]
    for folder, motion in [*motions, *((PASSAGES, passage) for passage in draft.body.passages)]:
        report = draft.report(folder, motion.name)
        if report.diagnostics:
            continue
        units = joint_units(report.document.data)
        fast, far = memoize(("excess", folder, motion.name), (motion, body), partial(_excesses, motion, body))
        for excesses in _by_key(fast):
            _too_fast(report, excesses, units, draft.body)
        for excess in far:
            _too_far(report, excess, units, draft.body)


def _excesses(motion: MotionDefinition, body: Body) -> tuple[tuple[Excess, ...], tuple[Excess, ...]]:
    """Return the points at which a joint is too fast, and the points at which it exceeds its limits."""
    course = Trajectory(motion)
    return tuple(overspeed(motion, body, course)), tuple(beyond_limits(motion, body, course))


def _by_key(fast: Iterable[Excess]) -> list[list[Excess]]:
    """Return the excesses of each keyframe, the worst first.

    They are combined, because a keyframe that comes too soon is too soon for all its joints.
    """
    keys: dict[NodePath, list[Excess]] = {}
    for excess in sorted(fast, key=lambda e: -e.value / e.limit):
        keys.setdefault(_keyframe(excess.key.where), []).append(excess)
    return list(keys.values())


def _keyframe(where: NodePath) -> NodePath:
    """Return the path of the keyframe that contains a key; the path itself if the key is in no keyframe."""
    return where[: max((n for n, step in enumerate(where) if step == "keyframes"), default=len(where)) + 2]


def _too_fast(report: DocumentReport, excesses: Sequence[Excess], units: JointUnits, body: Body) -> None:
    excess, *others = excesses
    value, limit = _shown(excess, units, body)
    unit = units.name(excess.joint, body)
    what = f" {unit}/s" if unit else ""
    message = f"`{excess.joint}` would have to move at {value:g}{what} to get here in time, but its limit is {limit:g}"
    if others:
        names = ", ".join(f"`{name}`" for name in list(dict.fromkeys(e.joint for e in others))[:3])
        message += f"; also too fast: {names}{' and others' if len(others) > 3 else ''}"
    longer = more_time(excess.value / excess.limit)
    cause = f"{report.document.file} {value:g} {limit:g}"  # the same for left and right, and each use of a pose
    report(
        TOO_FAST,
        excess.key.where,
        message,
        f"give it {longer}",
        cause=cause,
        root=f"the speed of `{excess.joint}` in models/",
    )


def more_time(factor: float) -> str:
    """Return in words how much more time a movement needs if it is `factor` times too fast.

    The value is rounded up to two digits.
    """
    if factor >= 2:
        digits = 10.0 ** (len(str(int(factor))) - 2)
        return f"{ceil(factor / digits) * digits:g} times as much time"
    return f"{ceil(100 * (factor - 1))} % more time"


def _too_far(report: DocumentReport, excess: Excess, units: JointUnits, body: Body) -> None:
    value, limit = _shown(excess, units, body)
    unit = units.name(excess.joint, body) or units.angle
    message = f"`{excess.joint}` would reach {value:g} {unit} here, but its limit is {limit:g}"
    coupled = [c.on for c in body.coupled if c.joint == excess.joint]
    hint = (
        f"change the angle of `{coupled[0]}`, on which the limit depends"
        if coupled
        else "move the handles closer to the key"
    )
    cause = f"{report.document.file} {message}"
    report(
        ANGLE_OUT_OF_RANGE,
        excess.key.where,
        message,
        hint,
        cause=cause,
        root=f"the range of `{excess.joint}` in models/",
    )


def _shown(excess: Excess, units: JointUnits, body: Body) -> tuple[float, float]:
    """Return value and limit in the file's unit, rounded to the fewest digits that keep them different."""
    factor = units.factor(excess.joint, body)
    value, limit = excess.value / factor, excess.limit / factor
    digits = next((d for d in range(1, 6) if round(value, d) != round(limit, d)), 6)
    return round(value, digits), round(limit, digits)
