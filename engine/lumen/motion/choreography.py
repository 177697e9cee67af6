"""Motions made of motions: mirrored, faster, joined. The functions are pure and don't change their arguments."""

import re
from collections.abc import Iterable, Mapping
from dataclasses import replace

from lumen.language.diagnostics import NodePath
from lumen.language.mirrors import Mirror
from lumen.language.motions import Cue, Keyframe, MotionDefinition

_SOON = 1e-9
"""The shortest time between two keys of a joint [s]."""

_LED_SIDE = re.compile(r"(left|right)(?=_)")
_OTHER = {"left": "right", "right": "left"}


def mirrored(motion: MotionDefinition, mirror: Mirror) -> MotionDefinition:
    """Return the motion with left and right exchanged; mirroring twice gives the original.

    Joints without a counterpart are left out.
    """
    tracks, origin = {}, {}
    for joint, keys in motion.tracks.items():
        other, sign = mirror.get(joint, (joint, 1.0))
        if other:
            tracks[other] = tuple(_turned(key, sign) for key in keys)
        if other and joint in motion.origin:
            origin[other] = sign * motion.origin[joint]
    cues = tuple(_mirrored_cue(cue) for cue in motion.cues)
    return replace(motion, tracks=tracks, origin=origin, cues=cues)


def at_speed(motion: MotionDefinition, speed: float) -> MotionDefinition:
    """Return the motion `speed` times as fast; `speed` must be positive."""
    tracks = {joint: tuple(_faster(key, speed) for key in keys) for joint, keys in motion.tracks.items()}
    cues = tuple(replace(cue, time=cue.time / speed) for cue in motion.cues)
    return replace(motion, duration=motion.duration / speed, tracks=tracks, cues=cues)


def placed(motion: MotionDefinition, where: NodePath) -> MotionDefinition:
    """Return the motion with `where` as the place of every key and cue, for a motion that another file plays."""
    tracks = {joint: tuple(replace(key, where=where) for key in keys) for joint, keys in motion.tracks.items()}
    return replace(motion, tracks=tracks, cues=tuple(replace(cue, where=where) for cue in motion.cues))


def trailing(motion: MotionDefinition, lags: Mapping[str, float]) -> MotionDefinition:
    """Return the motion with these joints delayed by their lags [s], for parts that hang on a limb and follow it.

    The duration is unchanged: near the end, a delayed joint catches up.
    """

    def later(key: Keyframe, lag: float) -> Keyframe:
        left = motion.duration - key.time
        return replace(key, time=key.time + lag if left > 2 * lag else motion.duration - left / 2)

    late = {j: tuple(later(key, lags[j]) for key in keys) for j, keys in motion.tracks.items() if j in lags}
    return replace(motion, tracks={**motion.tracks, **late})


def joined(parts: Iterable[tuple[float, MotionDefinition]], duration: float) -> MotionDefinition:
    """Return one motion made of parts, each with its start time [s].

    The parts must be in order and must not overlap.
    """
    tracks: dict[str, list[Keyframe]] = {}
    cues: list[Cue] = []
    for begin, part in parts:
        for joint, keys in part.tracks.items():
            tracks.setdefault(joint, []).extend(_later(key, begin) for key in keys)
        cues.extend(replace(cue, time=begin + cue.time) for cue in part.cues)
    return MotionDefinition("", duration, {joint: tuple(keys) for joint, keys in tracks.items()}, tuple(cues))


def returning(part: MotionDefinition, angles: Mapping[str, float], pause: float, where: NodePath) -> MotionDefinition:
    """Return the motion with `pause` [s] appended to move back to `angles`, unless it already ends there."""
    away = [j for j, keys in part.tracks.items() if j in angles and abs(keys[-1].angle - angles[j]) > 1e-3]
    if not away:
        return part
    last = {joint: part.tracks[joint][-1] for joint in away}
    hold = {joint: (replace(key, time=0.0),) for joint, key in last.items() if key.time < part.duration - _SOON}
    back = {joint: (Keyframe(pause, angles[joint], where=where),) for joint in away}
    return joined(
        [
            (0.0, part),
            (part.duration, MotionDefinition("", 0.0, hold)),
            (part.duration, MotionDefinition("", pause, back)),
        ],
        part.duration + pause,
    )


def _later(key: Keyframe, begin: float) -> Keyframe:
    """Return the key moved `begin` [s] later.

    A motion can have thousands of keys, and `replace` would take three times as long.
    """
    if not begin:
        return key
    return Keyframe(begin + key.time, key.angle, key.interpolation, key.handle_in, key.handle_out, key.where)


def _turned(key: Keyframe, sign: float) -> Keyframe:
    (dt_in, da_in), (dt_out, da_out) = key.handle_in, key.handle_out
    return replace(key, angle=sign * key.angle, handle_in=(dt_in, sign * da_in), handle_out=(dt_out, sign * da_out))


def _faster(key: Keyframe, speed: float) -> Keyframe:
    (dt_in, da_in), (dt_out, da_out) = key.handle_in, key.handle_out
    return replace(key, time=key.time / speed, handle_in=(dt_in / speed, da_in), handle_out=(dt_out / speed, da_out))


def _mirrored_cue(cue: Cue) -> Cue:
    if cue.kind != "leds" or not isinstance(cue.value, dict):
        return cue
    return replace(cue, value={_LED_SIDE.sub(lambda m: _OTHER[m[1]], group): v for group, v in cue.value.items()})
