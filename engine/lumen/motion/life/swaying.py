"""To and fro: breathing, and weight that goes from one leg to the other."""

from functools import cache
from math import pi, sin

from lumen.language.life import LifeStyle
from lumen.motion.life.chance import chance

_WANDERING = ((0.5, 1.0), (0.3, 0.618), (0.2, 1.732))
"""Parts of a sway that wanders: how much of it, and how fast; no two of these ever come together again."""

SPEED_SHARE = 0.3
"""The part of its greatest speed that a joint uses of its own accord."""

PEAK_SLOPE = 2 * pi * max(1.0, sum(part * pace for part, pace in _WANDERING))
"""The greatest speed of a sway, for an amplitude of 1 and a period of 1 s."""


def sway(style: LifeStyle, seed: int, t: float) -> dict[str, float]:
    """How far each joint is from where it stands at `t` [s], in [rad; hands 0..1]."""
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
