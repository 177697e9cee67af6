"""Ways of joints that all robots share: to the posture that a motion begins in, and back to it after a cancel."""

from collections.abc import Collection, Mapping
from dataclasses import replace

from lumen.errors import BadCommandError
from lumen.language.body_parts import LEGS, part_of
from lumen.language.motions import MotionDefinition
from lumen.language.robots import Body
from lumen.motion.choreography import joined
from lumen.motion.limits import LIMIT_SLACK
from lumen.motion.trajectories import track

APPROACH_TIME, RECOVERY_TIME = 1.2, 0.8
"""The shortest time [s] to the posture that a motion begins in, and back to it from a cancelled motion."""

LOOK_SPEED = 1.5
"""The speed of a head that turns to look somewhere [rad/s]."""

SPEED_SHARE = 0.8
"""The part of its greatest speed that a joint uses at most on these ways."""

SMOOTH_PEAK = 1.5
"""The greatest speed of a smoothstep, as a multiple of its mean speed."""


def way_duration(way: Mapping[str, float], body: Body, least: float) -> float:
    """Return the time [s] in which joints move smoothly by `way` [rad]: `least`, or what the slowest joint needs."""
    slowest = max((abs(far) / body.joints[name].speed for name, far in way.items()), default=0.0)
    return max(least, slowest * SMOOTH_PEAK / SPEED_SHARE)


def home_angles(motion: MotionDefinition, body: Body, owned: Collection[str]) -> dict[str, float]:
    """Return the angles [rad] of the motion's start posture, for joints in the parts `owned`; empty without one."""
    part = part_of(body)
    return {name: angle for name, angle in body.postures.get(motion.start, {}).items() if part.get(name) in owned}


def away(home: Mapping[str, float], here: Mapping[str, float], body: Body, tolerance: float) -> bool:
    """Return whether a joint of the legs is farther than `tolerance` [rad] from the posture that a motion begins in."""
    return any(abs(here[name] - home[name]) > tolerance for name in body.parts.get(LEGS, ()) if name in home)


def begun_from(motion: MotionDefinition, body: Body, here: Mapping[str, float]) -> MotionDefinition:
    """Return the motion, delayed until no joint is too fast on the way from `here` [rad] to its first key.

    `motion` is within the limits of the body, so only the ways to the first two keys depend on `here`. Raises
    BadCommandError if a joint is too fast to its second key.
    """
    delay = max((_delay(motion, joint, here, body) for joint, keys in motion.tracks.items() if keys), default=0.0)
    if not delay:
        return motion
    later = joined([(delay, motion)], motion.duration + delay)
    return replace(motion, duration=later.duration, tracks=later.tracks, cues=later.cues)


def _delay(motion: MotionDefinition, joint: str, here: Mapping[str, float], body: Body) -> float:
    """Return the additional time [s] that a joint needs to reach its first key.

    Raises BadCommandError if the joint is too fast to its second key.
    """
    keys, limit = motion.tracks[joint][:3], body.joints[joint].speed * (1 + LIMIT_SLACK)
    begin = here.get(joint, motion.origin.get(joint, keys[0].angle))
    first, *second = track(joint, keys, begin).segments[:2]
    if fast := [speed for segment in second if (speed := segment.peak_speed()) > limit]:
        raise BadCommandError(f"`{motion.name}` turns {joint} at {fast[0]:.1f} rad/s: at most {limit:.1f} is allowed")
    speed = first.peak_speed()
    return first.duration * (speed / (SPEED_SHARE * limit) - 1.0) if speed > limit else 0.0
