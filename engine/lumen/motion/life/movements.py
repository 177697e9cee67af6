"""Head movements of idle life: glances, nods, and turns towards touches and voices."""

from collections.abc import Collection, Mapping
from functools import cache, lru_cache
from math import cos, exp, floor, inf, pi, sin
from typing import NamedTuple
from zlib import crc32

from lumen.language.life import STILL, Asides, Blinks, Glances, LifeStyle, Nods, Settles
from lumen.language.machines import MachineDefinition, is_within


@lru_cache(4096)
def chance(seed: int, what: str, number: int) -> float:
    """Return a number in [0, 1) that depends only on the arguments."""
    return crc32(f"{seed} {what} {number}".encode()) / 2**32


def moments(seed: int, what: str, every: float, t: float, length: float) -> tuple[int, float] | None:
    """Return the number of the event that is in progress at `t` [s], and its age [s]; None for no event.

    One event of `length` [s] falls into each interval of `every` [s], which must be longer.
    """
    number = floor(t / every)
    since = t - (number + chance(seed, what, number) * max(0.0, 1.0 - length / every)) * every
    return (number, since) if 0.0 <= since < length else None


def eyes_closed(blinks: Blinks, seed: int, t: float) -> bool:
    """Return True if the robot blinks at `t` [s]."""
    return moments(seed, "blink", blinks.every, t, blinks.length) is not None


_WANDERING = ((0.5, 1.0), (0.3, 0.618), (0.2, 1.732))
"""The components of a wandering sway, each with its share and relative frequency; they never repeat together."""

SPEED_SHARE = 0.3
"""The part of its maximum speed that a joint uses in idle life."""

PEAK_SLOPE = 2 * pi * max(1.0, sum(part * pace for part, pace in _WANDERING))
"""Peak speed of a sway, for an amplitude of 1 and a period of 1 s."""


def sway(style: LifeStyle, seed: int, t: float) -> dict[str, float]:
    """Return the offset of each joint [rad; hands 0..1] at `t` [s]."""
    found: dict[str, float] = {}
    for each in style.sways:
        phases, turns = _phases(seed, each.name), 2 * pi * t / each.period
        if each.wanders:
            level = sum(part * sin(pace * turns + phases[i]) for i, (part, pace) in enumerate(_WANDERING))
        else:
            level = sin(turns + phases[0])
        for joint, angle in each.joints.items():
            found[joint] = found.get(joint, 0.0) + angle * level
    return found


@cache
def _phases(seed: int, name: str) -> tuple[float, ...]:
    return tuple(2 * pi * chance(seed, name, i) for i in range(len(_WANDERING)))


_DECAY, _TURN = 3.0, 4.0
"""Parameters of a damped mass-spring system that settles within 1 s and overshoots by a tenth."""

SETTLE_SLOPE = 2.5
"""Peak speed of settling, for an angle of 1 in 1 s: that of the mass after atan(4 / 3) / 4 s."""


def settle(settles: Settles, since: float) -> Mapping[str, float]:
    """Return the joints' offsets `since` [s] after the last movement [rad; hands 0..1]."""
    u = since / settles.takes
    level = 1.0 - exp(-_DECAY * u) * (cos(_TURN * u) + _DECAY / _TURN * sin(_TURN * u))
    return {joint: level * angle for joint, angle in settles.joints.items()}


WARM, HOT = 60.0, 72.0
"""In idle life, a part moves less if its motors are warmer than `WARM`, and not at all from `HOT` on [°C]."""

LOW, EMPTY = 25.0, 5.0
"""Idle life is reduced if the charge of the battery is below `LOW`, and absent from `EMPTY` down [%]."""


def vigour(temperature: float, percentage: float) -> float:
    """Return the factor on the amplitudes, 0 to 1, for a motor temperature [°C] and the charge of the battery [%]."""
    cool = (HOT - temperature) / (HOT - WARM)
    charged = (percentage - EMPTY) / (LOW - EMPTY)
    return max(0.0, min(1.0, cool, charged))


def style_name(machine: MachineDefinition, configuration: Collection[str]) -> str:
    """Return the style that the active states set with `life`; `still` if no state sets one.

    A state's `life` also applies to its descendants, until one of them sets another. Among parallel states `still` has
    priority; otherwise the first one in the file decides.
    """
    active = [path for path, state in machine.states.items() if not path or state.name in configuration]
    saying = [path for path in active if machine.states[path].life]
    inner = [path for path in saying if not any(other != path and is_within(other, path) for other in saying)]
    styles = [machine.states[path].life for path in inner]
    return STILL if STILL in styles or not styles else styles[0]


def gestures_wanted(machine: MachineDefinition, configuration: Collection[str]) -> bool:
    """Return True unless an active state has `gestures: none`."""
    return not any(state.gestures for path, state in machine.states.items() if not path or state.name in configuration)


TURN_TIME = 0.5
"""The time that the head takes to turn to a glance, and to turn back [s]."""

NOD_TIME = 0.7
"""Duration of a nod [s]."""


class Attention(NamedTuple):
    """A direction that has the robot's attention."""

    yaw: float
    """The yaw of the head, to the left [rad]."""
    pitch: float
    """The pitch of the head, down [rad]."""
    at: float
    """When it got the robot's attention [s]."""
    latest: float = -inf
    """The time of the newest stimulus, if there were several [s]."""

    def again(self, yaw: float, pitch: float, lasts: float, now: float) -> "Attention":
        """Return the attention to a new place; a head that has already turned does not return first."""
        return Attention(yaw, pitch, now - min(TURN_TIME, lasts / 2) * _phase(self, lasts, now), now)


TOUCHED = {
    "FrontTactil": (0.0, -0.25), "MiddleTactil": (0.0, -0.3), "RearTactil": (0.0, -0.35),
    "HandLeftBack": (0.6, 0.3), "HandLeftLeft": (0.6, 0.3), "HandLeftRight": (0.6, 0.3),
    "HandRightBack": (-0.6, 0.3), "HandRightLeft": (-0.6, 0.3), "HandRightRight": (-0.6, 0.3),
    "LeftBumper": (0.25, 0.4), "RightBumper": (-0.25, 0.4), "ChestButton": (0.0, 0.35),
}  # fmt: skip
"""The direction of a person who touches this sensor of a NAO: yaw to the left, pitch down [rad]."""


def glance(glances: Glances, seed: int, t: float) -> tuple[float, float]:
    """Return the head's offset at `t` [s] due to glances: (yaw, pitch) [rad]."""
    if (now := moments(seed, "glance", glances.every, t, _length(glances))) is None:
        return 0.0, 0.0
    number, since = now
    part = pulse(since, _length(glances))
    yaw, pitch = (2 * chance(seed, way, number) - 1 for way in ("glance yaw", "glance pitch"))
    return part * glances.yaw * yaw, part * glances.pitch * pitch


def nod(nods: Nods, seed: int, t: float) -> float:
    """Return the head's downward offset at `t` [s] due to nods [rad]."""
    now = moments(seed, "nod", nods.every, t, NOD_TIME)
    return 0.0 if now is None else nods.pitch * pulse(now[1], NOD_TIME)


def look_towards(attention: Attention | None, lasts: float, t: float) -> tuple[float, float]:
    """Return the head's offset at `t` [s] due to attention that lasts for `lasts` [s]: (yaw, pitch) [rad]."""
    if attention is None:
        return 0.0, 0.0
    part = _smooth(_phase(attention, lasts, t))
    return part * attention.yaw, part * attention.pitch


def aside(asides: Asides, seed: int, number: int, since: float) -> tuple[float, float]:
    """Return the head's offset `since` [s] after answer `number` began: (yaw, pitch) [rad], (0, 0) at the end.

    People look away, mostly up, while they plan what to say; robots that do so look thoughtful (Andrist, Tan, Gleicher,
    Mutlu: Conversational gaze aversion for humanlike robots, HRI 2014, on a NAO).
    """
    length = asides.hold + 2 * TURN_TIME
    part = pulse(since, length) if 0.0 <= since < length else 0.0
    side = 1 if chance(seed, "aside", number) < 0.5 else -1
    return part * side * asides.yaw, -part * asides.pitch


def pulse(since: float, length: float) -> float:
    """Return a smooth pulse from 0 to 1 and back within `length` [s]; `since` is the time from its beginning [s]."""
    turn = min(TURN_TIME, length / 2)
    return _smooth(max(0.0, min(1.0, since / turn, (length - since) / turn)))


def _phase(attention: Attention, lasts: float, t: float) -> float:
    """Return the part of the turn that is complete, 0 to 1, before smoothing."""
    turn, end = min(TURN_TIME, lasts / 2), max(attention.at, attention.latest) + lasts
    return max(0.0, min(1.0, (t - attention.at) / turn, (end - t) / turn)) if turn else 0.0


def _smooth(u: float) -> float:
    return u * u * u * (10 + u * (6 * u - 15))


def _length(glances: Glances) -> float:
    return min(glances.hold + 2 * TURN_TIME, glances.every)
