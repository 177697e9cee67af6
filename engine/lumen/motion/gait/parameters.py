"""The parameters of a gait, and how they follow from the dimensions of the legs."""

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from math import sqrt
from typing import NamedTuple

from lumen.motion.gait.legs import LegGeometry


@dataclass(frozen=True, slots=True)
class GaitParameters:
    """The parameters of a gait: times in [s], lengths in [m], angles in [rad].

    The defaults were found in simulation: this pace works with every mass and on every floor that was tried.
    """

    double: float = 0.10
    """Time of a step on both feet."""
    single: float = 0.35
    """Time of a step on one foot."""
    forward: float = 0.065
    """Greatest step forward."""
    sideways: float = 0.04
    """Greatest step sideways."""
    turn: float = 0.25
    """Greatest turn in a step."""
    lift: float = 0.025
    """Height of the lifted foot."""
    torso: float = 0.315
    """Height of the torso's origin."""
    lean: float = 0.05
    """Forward inclination of the torso."""
    apart: float = 0.1
    """Distance between the feet, measured between the middle lines of the ankles."""
    narrowest: float = 0.085
    """Smallest such distance, across the bearing foot: below it, the soles touch."""
    widest: float = 0.16
    """Greatest such distance, in sideways steps."""
    ahead: float = 0.02
    """Distance of the bearing point in front of the ankles."""
    inside: float = 0.012
    """Distance of the bearing point inside the ankles: it leaves more of the sole to resist an outward push."""
    sole_ahead: float = 0.035
    """Greatest forward shift of the bearing point that a plan may use."""
    sole_aside: float = 0.015
    """Greatest sideways shift of the bearing point, on one sole."""
    shift: float = 0.35
    """Time for the weight to shift before the first step."""
    settle: float = 0.35
    """Time to settle at the end of a walk."""


class Paces(NamedTuple):
    """The paces of one body."""

    usual: GaitParameters = GaitParameters()
    """The normal pace."""
    gentle: GaitParameters = GaitParameters(forward=0.03, sideways=0.02, turn=0.12, lift=0.02)
    """Shorter and lower steps, for a robot with hot motors."""
    brisk: GaitParameters = GaitParameters(
        double=0.04, single=0.3, forward=0.081, sideways=0.061, turn=0.4, lift=0.032, widest=0.212
    )
    """For walks at a requested speed; found by a search (docs/decisions/074): faster, but less accurate at the goal."""
    catching: GaitParameters = GaitParameters(torso=0.3)
    """For steps that catch a fall: the torso is lower, so that feet far apart reach the ground."""


FOUND = Paces()
"""The paces found in simulation, for legs of the length `FOUND_LENGTH`."""

FOUND_LENGTH, FOUND_BELOW, FOUND_SPEED = 0.1 + 0.1029, 0.085 + 0.04511, 6.40239
"""Hip to ankle [m]; hip below the torso's origin plus ankle above the ground [m]; speed of pitch joints [rad/s]."""

FOUND_SOLE_LENGTH, FOUND_SOLE_WIDTH = 0.14, 0.074
FOUND_GAP, FOUND_ROOM = 0.029, 0.015
"""Gap between two soles that pass each other, and additional distance of standing feet [m]."""

REST_OF_TOE, REST_OF_INNER = 0.8, 3 / 7
"""The bearing point, as parts of the distance from the ankle to the sole's middle, and to its inner edge."""


def scale_of(legs: LegGeometry) -> float:
    """Return the length of these legs relative to those for which the paces were found."""
    return legs.length / FOUND_LENGTH


def time_scale_of(legs: LegGeometry) -> float:
    """Return the time scale of a body on these legs: how slowly it falls, or its joints turn if that is slower."""
    falls = sqrt(scale_of(legs))
    return falls * max(1.0, FOUND_SPEED / (legs.speed * falls))


def paces_of(legs: LegGeometry, kept: Mapping[str, Mapping[str, float]] | None = None) -> Paces:
    """Return the paces of a body on these legs: lengths scale with the legs, times with `time_scale_of`.

    `kept` has parameters found for this body in particular, by the name of the pace. Parameters of the usual pace apply
    to the other paces too, except those in which they differ from it by rule.
    """
    return _kept(Paces(*(_by_rule(pace, legs) for pace in FOUND)), kept or {})


def paces_without_legs(kept: Mapping[str, Mapping[str, float]]) -> Paces:
    """Return the paces of a body without measured legs: the found ones, with the parameters in `kept`."""
    return _kept(FOUND, kept)


def _kept(ruled: Paces, kept: Mapping[str, Mapping[str, float]]) -> Paces:
    """Return these paces with the parameters in `kept`."""
    usual = replace(ruled.usual, **kept.get("usual", {}))
    paces = {}
    for name, found in FOUND._asdict().items():
        differs = [f.name for f in fields(found) if getattr(found, f.name) != getattr(FOUND.usual, f.name)]
        own = {field: getattr(getattr(ruled, name), field) for field in differs}
        paces[name] = replace(usual, **{**own, **kept.get(name, {})})
    return Paces(**paces)


def _by_rule(pace: GaitParameters, legs: LegGeometry) -> GaitParameters:
    """Return the parameters `pace`, scaled to these legs."""
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
