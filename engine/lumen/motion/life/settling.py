"""A body that comes to rest: joints sink a little beyond where they settle, and back."""

from collections.abc import Mapping
from math import cos, exp, sin

from lumen.language.life import Settles

_DECAY, _TURN = 3.0, 4.0
"""Of a mass on a damped spring that was let go, for a settling of 1 s: it goes a tenth beyond its rest."""

SETTLE_SLOPE = 2.5
"""The greatest speed of a settling, for an angle of 1 and 1 s: that of the mass after atan(4 / 3) / 4 s."""


def settle(settles: Settles, since: float) -> Mapping[str, float]:
    """How far joints have sunk `since` so long [s] nothing moves them [rad; hands 0..1]."""
    u = since / settles.takes
    level = 1.0 - exp(-_DECAY * u) * (cos(_TURN * u) + _DECAY / _TURN * sin(_TURN * u))
    return {joint: level * angle for joint, angle in settles.joints.items()}
