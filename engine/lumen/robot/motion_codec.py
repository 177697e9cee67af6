"""Motions as JSON data: a message contains the whole motion, so that its receiver needs no file."""

from collections.abc import Mapping
from itertools import pairwise
from math import isfinite
from typing import Any

from lumen.errors import BadCommandError
from lumen.language.diagnostics import did_you_mean
from lumen.language.motions import Cue, Interpolation, Keyframe, MotionDefinition
from lumen.language.robots import Body

MAX_MOTION_DURATION = 600.0
"""The longest motion from the bus [s]."""
MAX_MOTION_KEYS = 20_000
"""The greatest number of keys and cues of one motion."""
LIMIT_TOLERANCE = 1e-6
"""An angle may exceed its joint's limit by this, because decimals are rounded [rad]."""


def encode_motion(motion: MotionDefinition) -> dict[str, Any]:
    """Return a motion as JSON data: keys are `[time, angle, interpolation, *handle_in, *handle_out]`, [s] and [rad]."""
    tracks = {joint: [_row(key) for key in keys] for joint, keys in motion.tracks.items()}
    cues = [[cue.time, cue.kind, cue.value] for cue in motion.cues]
    ends = {"start": motion.start, "end": motion.end, "origin": dict(motion.origin)}
    return {"name": motion.name, "duration": motion.duration, "tracks": tracks, "cues": cues, **ends}


def decode_motion(data: Any, body: Body) -> MotionDefinition:
    """Return the motion in the data, for this body.

    Raises BadCommandError for malformed data, too many keys, an invalid duration, joints and postures that the body
    lacks, and angles beyond limits.
    """
    if not isinstance(data, Mapping):
        raise BadCommandError("a `motion` must be an object with `name`, `duration` and `tracks`")
    name, tracks, cues = data.get("name"), data.get("tracks"), data.get("cues", [])
    if not isinstance(name, str) or not isinstance(tracks, Mapping) or not isinstance(cues, list):
        raise BadCommandError("a `motion` needs a `name`, and `tracks` with the keys of each joint")
    name = "".join(sign for sign in name[:80] if sign.isprintable())
    if sum(len(keys) for keys in tracks.values() if isinstance(keys, list)) + len(cues) > MAX_MOTION_KEYS:
        raise BadCommandError(f"`{name}` has more than {MAX_MOTION_KEYS:,} keys and cues")
    duration = _number(data.get("duration"), f"the `duration` of `{name}`")
    if not 0.0 <= duration <= MAX_MOTION_DURATION:
        raise BadCommandError(f"`{name}` must take 0 to {MAX_MOTION_DURATION:g} s, not {duration:g} s")
    start, end = (_posture(data.get(key, ""), body) for key in ("start", "end"))
    origin = data.get("origin", {})
    if not isinstance(origin, Mapping):
        raise BadCommandError(f"the `origin` of `{name}` must be an angle for each joint")
    return MotionDefinition(
        name,
        duration,
        {_joint(joint, body): _track(joint, keys, body) for joint, keys in tracks.items()},
        tuple(_cue(cue, name) for cue in cues),
        start,
        end,
        {_joint(joint, body): _angle(joint, angle, body) for joint, angle in origin.items()},
    )


def _row(key: Keyframe) -> list[Any]:
    return [key.time, key.angle, str(key.interpolation), *key.handle_in, *key.handle_out]


def _track(joint: str, keys: Any, body: Body) -> tuple[Keyframe, ...]:
    """Return the keys of a joint. Raises BadCommandError unless their times are above 0 and increase."""
    found = tuple(_key(joint, row, body) for row in keys) if isinstance(keys, list) else ()
    times = [0.0, *(key.time for key in found)]
    if not found or any(after <= before for before, after in pairwise(times)):
        raise BadCommandError(f"the times of the keys of `{joint}` must be above 0 and increase")
    return found


def _key(joint: str, row: Any, body: Body) -> Keyframe:
    if not isinstance(row, list) or not 2 <= len(row) <= 7 or len(row) in (4, 6):
        raise BadCommandError(f"a key of `{joint}` must be a list of its time, angle, interpolation and handles")
    time, angle = _number(row[0], f"a time of `{joint}`"), _angle(joint, row[1], body)
    if len(row) > 2 and row[2] not in list(Interpolation):
        raise BadCommandError(
            f"there is no interpolation `{str(row[2])[:40]}` for `{joint}`: {did_you_mean(str(row[2]), Interpolation)}"
        )
    kind = Interpolation(row[2]) if len(row) > 2 else Interpolation.MINIMUM_JERK
    handles = [_number(value, f"a handle of `{joint}`") for value in row[3:]] + [0.0] * (7 - max(len(row), 3))
    return Keyframe(time, angle, kind, (handles[0], handles[1]), (handles[2], handles[3]))


def _cue(cue: Any, name: str) -> Cue:
    if not isinstance(cue, list) or len(cue) != 3 or not isinstance(cue[1], str):
        raise BadCommandError(f"a cue of `{name}` must be a list of its time, kind and value")
    return Cue(_number(cue[0], f"the time of a cue of `{name}`"), cue[1], cue[2])


def _joint(joint: Any, body: Body) -> str:
    if joint not in body.joints:
        raise BadCommandError(f"there is no joint `{str(joint)[:40]}`: {did_you_mean(str(joint)[:40], body.joints)}")
    return str(joint)


def _angle(joint: str, angle: Any, body: Body) -> float:
    value, limit = _number(angle, f"an angle of `{joint}`"), body.joints[_joint(joint, body)]
    if not limit.minimum - LIMIT_TOLERANCE <= value <= limit.maximum + LIMIT_TOLERANCE:
        raise BadCommandError(
            f"`{joint}` can move from {limit.minimum:.3f} to {limit.maximum:.3f} rad, not to {value:.3f}"
        )
    return value


def _posture(name: Any, body: Body) -> str:
    if name and name not in body.postures:
        raise BadCommandError(f"there is no posture `{str(name)[:40]}`: {did_you_mean(str(name)[:40], body.postures)}")
    return str(name)


def _number(value: Any, what: str) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not isfinite(value):
        raise BadCommandError(f"{what} must be a number")
    return float(value)
