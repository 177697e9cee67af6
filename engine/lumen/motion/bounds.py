"""Brings commands within the joint limits and speeds of a body, in one place for all robots that perform them."""

import weakref
from bisect import bisect_left
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from itertools import pairwise
from math import degrees, isfinite
from types import MappingProxyType
from typing import NamedTuple

from lumen.errors import BadCommandError
from lumen.language.commands import Look
from lumen.language.motions import Keyframe, MotionDefinition
from lumen.language.robots import Body
from lumen.motion.limits import LIMIT_SLACK, Excess, beyond_limits, coupled_range, overspeed
from lumen.ports import Aim, NativeCommand, Perform

MAX_FITS = 50
"""The greatest number of rounds of changes: one change may require another, and each brings the motion closer."""

SPEED_MARGIN = 1.005
"""Factor on the time that a joint needs, so that rounding does not make the joint too fast again."""


NOWHERE: Mapping[str, float] = MappingProxyType({})
"""The present angles of joints if no angle is known."""


class BoundedCommand(NamedTuple):
    """A command that a body can perform, and the changes for the log; it is the same object if nothing had to change.

    Changes of an aim are not listed, because aims arrive as a stream.
    """

    command: NativeCommand
    changes: tuple[str, ...] = ()


def within_limits(command: NativeCommand, body: Body) -> BoundedCommand:
    """Return the nearest command that respects the limits of the joints, coupled limits included, and their speeds.

    Joints that the body lacks, and values that are not finite, are left unchanged. Raises BadCommandError for a motion
    that still exceeds the limits after `MAX_FITS` rounds of changes.
    """
    match command:
        case Look(yaw, pitch):
            wanted = body.roles.head_joints(yaw, pitch)
            angles = nearest_angles(wanted, body)
            if angles == wanted:
                return BoundedCommand(command)
            near = body.roles.head_angles(angles)
            turned = {path: near[i] for i, path in enumerate(("head.yaw", "head.pitch")) if body.roles.joint(path)}
            look = Look(turned.get("head.yaw", yaw), turned.get("head.pitch", pitch))
            return BoundedCommand(look, _changed("look", wanted, angles, body))
        case Aim():
            return BoundedCommand(aim_within(command, body))
        case Perform(motion):
            kept = _kept(motion, body)
            if not kept.fits:
                raise BadCommandError(f"`{motion.name}` can't be brought within the limits and speeds of the body")
            return BoundedCommand(Perform(kept.inside) if kept.inside else command, kept.changes)
        case _:
            return BoundedCommand(command)


def aim_within(aim: Aim, body: Body, here: Mapping[str, float] = NOWHERE) -> Aim:
    """Return the nearest aim that respects the joint limits, coupled limits included, with a speed of at most 1.

    `here` are the present angles of joints [rad], as far as they are known.
    """
    angles, speed = nearest_angles(aim.angles, body, here), min(aim.speed, 1.0)
    return aim if angles == aim.angles and speed == aim.speed else Aim(angles, speed)


def analyse(motions: Iterable[MotionDefinition], body: Body) -> None:
    """Analyse motions before they are played.

    The analysis of a dense motion takes longer than one tick of the robot's loop.
    """
    for motion in motions:
        _kept(motion, body)


def nearest_angles(wanted: Mapping[str, float], body: Body, here: Mapping[str, float] = NOWHERE) -> dict[str, float]:
    """Return the nearest angles [rad] inside the limits of these joints, coupled limits included.

    `here` are the present angles of other joints, as far as they are known. A joint in `here` that would exceed a
    coupled limit is added to the result.
    """
    near = dict(wanted)
    for name in near.keys() & body.joints.keys():
        joint = body.joints[name]
        if isfinite(near[name]):
            near[name] = min(max(near[name], joint.minimum), joint.maximum)
    for limit in body.coupled:
        angle, on = (near.get(name, here.get(name)) for name in (limit.joint, limit.on))
        if angle is not None and on is not None and isfinite(angle) and near.keys() & {limit.joint, limit.on}:
            low, high = coupled_range(limit, on)
            if limit.joint in near or not low <= angle <= high:
                near[limit.joint] = min(max(angle, low), high)
    return near


def _changed(verb: str, wanted: Mapping[str, float], near: Mapping[str, float], body: Body) -> tuple[str, ...]:
    return tuple(
        f"`{verb}` turns `{name}` to {_shown(name, near[name], body)}, not to {_shown(name, angle, body)}, which is"
        " beyond its limit"
        for name, angle in wanted.items()
        if near[name] != angle
    )


def _shown(joint: str, angle: float, body: Body) -> str:
    if joint in body.slides:
        return f"{1000 * angle:.1f} mm"
    return f"{angle:.3g}" if joint in body.hands else f"{degrees(angle):.1f} deg"


class _Analysis(NamedTuple):
    """The result of fitting a motion to a body; `inside` is None if the motion stays unchanged."""

    body: Body
    inside: MotionDefinition | None
    changes: tuple[str, ...]
    fits: bool


_analyses: dict[int, _Analysis] = {}
"""The newest analysis of each living motion, by its identity, because its tracks can't be hashed."""


def _kept(motion: MotionDefinition, body: Body) -> _Analysis:
    """Return the analysis of a motion, made once for each motion object and body."""
    found = _analyses.get(id(motion))
    if found is None or (found.body is not body and found.body != body):
        inside, changes, fits = _analysed(motion, body)
        if found is None:
            # Another motion may get the same id once this one is gone; at exit there is no need to clean up
            weakref.finalize(motion, _analyses.pop, id(motion), None).atexit = False
        found = _analyses[id(motion)] = _Analysis(body, inside if changes else None, changes, fits)
    return found


def _analysed(motion: MotionDefinition, body: Body) -> tuple[MotionDefinition, tuple[str, ...], bool]:
    """Return the motion inside the limits, slowed down if needed; the changes, once for each joint; and `fits`."""
    if not all(isfinite(x) for keys in motion.tracks.values() for key in keys for x in (key.time, key.angle)):
        return motion, (), True
    changes: dict[str, str] = {}
    for _ in range(MAX_FITS):
        if not (far := beyond_limits(motion, body)):
            break
        for excess in far:
            wanted, limit = (_shown(excess.joint, angle, body) for angle in (excess.value, excess.limit))
            changes.setdefault(
                f"far {excess.joint}",
                f"`{motion.name}` turns `{excess.joint}` to {limit}, not to {wanted}, which is beyond its limit",
            )
            keys = _cut(motion.tracks[excess.joint], excess)
            motion = replace(motion, tracks={**motion.tracks, excess.joint: keys})
    for _ in range(MAX_FITS):
        if not (fast := overspeed(motion, body)):
            break
        for excess in fast:
            at = excess.key.time
            change = f"`{motion.name}` takes longer: `{excess.joint}` needs more time to reach its key at {at:g} s"
            changes.setdefault(f"fast {excess.joint}", change)
        motion = slowed(motion, fast)
    fits = not changes or not (beyond_limits(motion, body) or overspeed(motion, body))
    return motion, tuple(changes.values()), fits


def _cut(keys: tuple[Keyframe, ...], excess: Excess) -> tuple[Keyframe, ...]:
    """Return the keys with the excess moved to the limit; the handles of a curve that exceeds it are removed."""
    i = bisect_left([key.time for key in keys], excess.key.time)
    if i == len(keys) or keys[i].time != excess.key.time:
        beside = replace(keys[min(i, len(keys) - 1)], time=excess.key.time, angle=excess.limit)
        return (*keys[:i], _level(beside), *keys[i:])
    changed = list(keys)
    if abs(keys[i].angle - excess.value) < LIMIT_SLACK:
        changed[i] = replace(_level(keys[i]), angle=excess.limit)
    else:
        changed[i] = replace(keys[i], handle_in=(0.0, 0.0))
        if i:
            changed[i - 1] = replace(keys[i - 1], handle_out=(0.0, 0.0))
    return tuple(changed)


def _level(key: Keyframe) -> Keyframe:
    return replace(key, handle_in=(0.0, 0.0), handle_out=(0.0, 0.0))


def slowed(motion: MotionDefinition, fast: Iterable[Excess]) -> MotionDefinition:
    """Return the motion with more time before the keys that come too soon; all joints and cues shift together."""
    times = [0.0, *sorted({key.time for keys in motion.tracks.values() for key in keys})]
    factors = [1.0] * len(times)
    for excess in fast:
        before = max((key.time for key in motion.tracks[excess.joint] if key.time < excess.key.time), default=0.0)
        for i in range(bisect_left(times, before) + 1, bisect_left(times, excess.key.time) + 1):
            factors[i] = max(factors[i], SPEED_MARGIN * excess.value / excess.limit)
    new = [0.0]
    for i, (begin, end) in enumerate(pairwise(times), start=1):
        new.append(new[-1] + (end - begin) * factors[i])

    def later(time: float) -> float:
        i = min(max(bisect_left(times, time), 1), len(times) - 1)
        return new[i] + (time - times[i]) * (factors[i] if time <= times[i] else 1.0)

    tracks = {joint: _retimed(keys, later) for joint, keys in motion.tracks.items()}
    cues = tuple(replace(cue, time=later(cue.time)) for cue in motion.cues)
    return replace(motion, duration=later(motion.duration), tracks=tracks, cues=cues)


def _retimed(keys: tuple[Keyframe, ...], later: Callable[[float], float]) -> tuple[Keyframe, ...]:
    """Return the keys at their new times; handles are scaled with the time to the next key, so the path is the same."""
    old = [keys[0].time - 1.0, *(key.time for key in keys), keys[-1].time + 1.0] if keys else []
    new = [later(time) for time in old]
    gaps = ([end - begin for begin, end in pairwise(times)] for times in (new, old))
    parts = [after / before for after, before in zip(*gaps, strict=True)]
    return tuple(
        replace(
            key,
            time=later(key.time),
            handle_in=(key.handle_in[0] * parts[i], key.handle_in[1]),
            handle_out=(key.handle_out[0] * parts[i + 1], key.handle_out[1]),
        )
        for i, key in enumerate(keys)
    )
