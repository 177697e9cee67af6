"""How a robot walks: the few numbers that a gait is made of, and how they follow from its legs."""

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from math import sqrt
from typing import NamedTuple

from lumen.motion.gait.legs import LegGeometry


@dataclass(frozen=True, slots=True)
class GaitParameters:
    """Times in [s], lengths in [m], angles in [rad]. Found in simulation: this pace walked with every mass and floor.

    A step takes `double` on both feet and `single` on one. With each step the body goes at most `forward`, `sideways`
    and `turn`. The torso's origin is carried `torso` high, leant forward by `lean`. Feet stand `apart`, their ankles'
    middle lines, never nearer than `narrowest`, across the one that bears: there the soles touch; and `widest` where
    they go aside. `ahead` is where the weight rests, in front of the ankles, and `inside`, nearer to the other foot: so
    much more of the sole is left to bear a push outward. A plan may shift it on one sole by `sole_ahead` and
    `sole_aside`. `shift` is how long the first step waits for the weight to move, `settle` the end of a walk.
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
    narrowest: float = 0.085
    widest: float = 0.16
    ahead: float = 0.02
    inside: float = 0.012
    sole_ahead: float = 0.035
    sole_aside: float = 0.015
    shift: float = 0.35
    settle: float = 0.35


class Paces(NamedTuple):
    """How one body walks: as a rule, with hot motors, where a speed is asked for, and after a fall that it caught."""

    usual: GaitParameters = GaitParameters()
    gentle: GaitParameters = GaitParameters(forward=0.03, sideways=0.02, turn=0.12, lift=0.02)
    """Shorter and lower steps, for a robot whose motors are hot."""
    brisk: GaitParameters = GaitParameters(
        double=0.04, single=0.3, forward=0.081, sideways=0.061, turn=0.4, lift=0.032, widest=0.212
    )
    """Found by a search (docs/decisions/074): faster, and less true where it ends."""
    catching: GaitParameters = GaitParameters(torso=0.3)
    """Lower than a walk: feet that stand far apart reach the ground."""


FOUND = Paces()
"""Found in simulation, on legs of `FOUND_LENGTH`."""

FOUND_LENGTH, FOUND_BELOW, FOUND_SPEED = 0.1 + 0.1029, 0.085 + 0.04511, 6.40239
"""From hip to ankle [m]; hip below the torso's origin and ankle above the ground [m]; of joints that pitch [rad/s]."""

FOUND_SOLE_LENGTH, FOUND_SOLE_WIDTH = 0.14, 0.074
FOUND_GAP, FOUND_ROOM = 0.029, 0.015
"""How far two soles pass each other, and how much farther apart they stand than that [m]."""

REST_OF_TOE, REST_OF_INNER = 0.8, 3 / 7
"""Where the weight rests: that part of the way from the ankle to the sole's middle, and to its inner edge."""


def scale_of(legs: LegGeometry) -> float:
    """How long these legs are, as a factor of those that the paces were found with."""
    return legs.length / FOUND_LENGTH


def time_scale_of(legs: LegGeometry) -> float:
    """How slowly a body on these legs falls, or its joints turn where that is slower, as a factor of time."""
    falls = sqrt(scale_of(legs))
    return falls * max(1.0, FOUND_SPEED / (legs.speed * falls))


def paces_of(legs: LegGeometry, kept: Mapping[str, Mapping[str, float]] | None = None) -> Paces:
    """How a body on these legs walks: lengths grow with the legs, times with how slowly it falls.

    What was found for this body in particular is `kept`: parameters by the name of a pace; what the other paces have in
    common with the usual one they keep in common.
    """
    return _kept(Paces(*(_by_rule(pace, legs) for pace in FOUND)), kept or {})


def paces_without_legs(kept: Mapping[str, Mapping[str, float]]) -> Paces:
    """How a body walks whose legs nobody has measured: as those that paces were found with, but for what is kept."""
    return _kept(FOUND, kept)


def _kept(ruled: Paces, kept: Mapping[str, Mapping[str, float]]) -> Paces:
    """These paces with what is kept of them."""
    usual = replace(ruled.usual, **kept.get("usual", {}))
    paces = {}
    for name, found in FOUND._asdict().items():
        differs = [f.name for f in fields(found) if getattr(found, f.name) != getattr(FOUND.usual, f.name)]
        own = {field: getattr(getattr(ruled, name), field) for field in differs}
        paces[name] = replace(usual, **{**own, **kept.get(name, {})})
    return Paces(**paces)


def _by_rule(pace: GaitParameters, legs: LegGeometry) -> GaitParameters:
    """That pace on these legs."""
    scale, slow, sole = scale_of(legs), time_scale_of(legs), legs.sole_size
    bent = (pace.torso - FOUND_BELOW) / FOUND_LENGTH
    narrowest = 2 * sole.inner + FOUND_GAP * scale
    apart = max(2 * legs.hip_out, narrowest + FOUND_ROOM * scale)
    ruled = {
        "double": pace.double * slow,
        "single": pace.single * slow,
        "forward": pace.forward * scale,
        "sideways": pace.sideways * scale,
        "turn": pace.turn,
        "lift": pace.lift * scale,
        "torso": legs.hip_down + legs.foot + bent * legs.length,
        "lean": pace.lean,
        "apart": apart,
        "narrowest": narrowest,
        "widest": apart + (pace.widest - pace.apart) * scale,
        "ahead": REST_OF_TOE * (sole.toe - sole.heel) / 2,
        "inside": REST_OF_INNER * sole.inner,
        "sole_ahead": pace.sole_ahead * (sole.toe + sole.heel) / FOUND_SOLE_LENGTH,
        "sole_aside": pace.sole_aside * (sole.outer + sole.inner) / FOUND_SOLE_WIDTH,
        "shift": pace.shift * slow,
        "settle": pace.settle * slow,
    }
    return GaitParameters(**{name: round(value, 6) for name, value in ruled.items()})
