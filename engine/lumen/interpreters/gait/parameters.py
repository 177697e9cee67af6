"""How the robot walks: the few numbers that a gait is made of."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class GaitParameters:
    """Times in [s], lengths in [m], angles in [rad]. Found in simulation: this pace walked with every mass and floor.

    A step takes `double` on both feet and `single` on one. With each step the body goes at most `forward`, `sideways`
    and `turn`. Feet stand `apart`, their ankles' middle lines, and `widest` where they go aside. `ahead` is where the
    weight rests, in front of the ankles, and `inside`, nearer to the other foot: so much more of the sole is left to
    bear a push outward. `shift` is how long the first step waits for the weight to move, `settle` the end of a walk.
    """

    double: float = 0.10
    single: float = 0.35
    forward: float = 0.065
    sideways: float = 0.04
    turn: float = 0.25
    lift: float = 0.025
    torso: float = 0.315
    lean: float = 0.05
    apart: float = 0.1
    widest: float = 0.16
    ahead: float = 0.02
    inside: float = 0.012
    shift: float = 0.35
    settle: float = 0.35


GENTLE_GAIT = GaitParameters(forward=0.03, sideways=0.02, turn=0.12, lift=0.02)
"""Shorter and lower steps, for a robot whose motors are hot."""

BRISK_GAIT = GaitParameters(double=0.04, single=0.3, forward=0.081, sideways=0.061, turn=0.4, lift=0.027, widest=0.212)
"""Found by a search (docs/decisions/074): faster, and less true where it ends."""
