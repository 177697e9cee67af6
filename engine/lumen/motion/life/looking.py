"""Where the head turns of its own accord: glances, nods, and where somebody touched or spoke."""

from math import inf
from typing import NamedTuple

from lumen.language.life import Asides, Glances, Nods
from lumen.motion.life.chance import chance, moments

TURN_TIME = 0.5
"""How long the head takes to where it glances, and back [s]."""

NOD_TIME = 0.7
"""How long a nod takes [s]."""


class Attention(NamedTuple):
    """Something at `yaw` to the left and `pitch` down [rad, of the head] asks to be looked at since `at` [s].

    It asked last at `latest` [s], if it asked several times.
    """

    yaw: float
    pitch: float
    at: float
    latest: float = -inf

    def again(self, yaw: float, pitch: float, lasts: float, now: float) -> "Attention":
        """Return the attention to a new place; a head that has already turned does not return first."""
        return Attention(yaw, pitch, now - min(TURN_TIME, lasts / 2) * _phase(self, lasts, now), now)


TOUCHED = {
    "FrontTactil": (0.0, -0.25), "MiddleTactil": (0.0, -0.3), "RearTactil": (0.0, -0.35),
    "HandLeftBack": (0.6, 0.3), "HandLeftLeft": (0.6, 0.3), "HandLeftRight": (0.6, 0.3),
    "HandRightBack": (-0.6, 0.3), "HandRightLeft": (-0.6, 0.3), "HandRightRight": (-0.6, 0.3),
    "LeftBumper": (0.25, 0.4), "RightBumper": (-0.25, 0.4), "ChestButton": (0.0, 0.35),
}  # fmt: skip
"""Where the head turns to somebody who touches NAO there: yaw to the left, pitch down [rad]."""


def glance(glances: Glances, seed: int, t: float) -> tuple[float, float]:
    """How far the head is turned at `t` [s] by glances: (yaw, pitch) [rad]."""
    if (now := moments(seed, "glance", glances.every, t, _length(glances))) is None:
        return 0.0, 0.0
    number, since = now
    part = pulse(since, _length(glances))
    yaw, pitch = (2 * chance(seed, way, number) - 1 for way in ("glance yaw", "glance pitch"))
    return part * glances.yaw * yaw, part * glances.pitch * pitch


def nod(nods: Nods, seed: int, t: float) -> float:
    """How far down the head is at `t` [s] by nods [rad]."""
    now = moments(seed, "nod", nods.every, t, NOD_TIME)
    return 0.0 if now is None else nods.pitch * pulse(now[1], NOD_TIME)


def look_towards(attention: Attention | None, lasts: float, t: float) -> tuple[float, float]:
    """How far the head is turned at `t` [s] to what asks for attention, for as long as that `lasts` [s]."""
    if attention is None:
        return 0.0, 0.0
    part = _smooth(_phase(attention, lasts, t))
    return part * attention.yaw, part * attention.pitch


def aside(asides: Asides, seed: int, number: int, since: float) -> tuple[float, float]:
    """How far the head is turned `since` so long [s] after answer `number` began: (yaw, pitch) [rad], (0, 0) after it.

    People look away, mostly up, while they plan what to say; robots that do so look thoughtful (Andrist, Tan, Gleicher,
    Mutlu: Conversational gaze aversion for humanlike robots, HRI 2014, on a NAO).
    """
    length = asides.hold + 2 * TURN_TIME
    part = pulse(since, length) if 0.0 <= since < length else 0.0
    side = 1 if chance(seed, "aside", number) < 0.5 else -1
    return part * side * asides.yaw, -part * asides.pitch


def pulse(since: float, length: float) -> float:
    """From 0 to 1 and back within `length` [s], without a jerk; `since` [s] its beginning."""
    turn = min(TURN_TIME, length / 2)
    return _smooth(max(0.0, min(1.0, since / turn, (length - since) / turn)))


def _phase(attention: Attention, lasts: float, t: float) -> float:
    """Return how much of the way to the place is done, 0 to 1, if all went at the same speed."""
    turn, end = min(TURN_TIME, lasts / 2), max(attention.at, attention.latest) + lasts
    return max(0.0, min(1.0, (t - attention.at) / turn, (end - t) / turn)) if turn else 0.0


def _smooth(u: float) -> float:
    return u * u * u * (10 + u * (6 * u - 15))


def _length(glances: Glances) -> float:
    return min(glances.hold + 2 * TURN_TIME, glances.every)
