"""Activation methods: they select the rules of a block that are applied, and change their degrees.

Each method receives the rules' degrees in order and returns them, with NaN for a rule that is not applied: not 0,
because a consequent such as `not Near` turns 0 into another degree.
"""

from collections.abc import Callable, Mapping
from math import inf, nan
from operator import eq, ge, gt, le, lt, ne
from typing import Any

from lumen.fuzzy.arithmetic import Arithmetic, Number, total
from lumen.language.controllers import Activation

Degrees = list[Number]

COMPARISON_FUNCTIONS: Mapping[str, Callable[[Any, Any], Any]] = {
    "<": lt,
    "<=": le,
    "==": eq,
    "!=": ne,
    ">=": ge,
    ">": gt,
}


def general(m: Arithmetic, activation: Activation, degrees: Degrees) -> Degrees:
    """Return all degrees unchanged."""
    return degrees


def first(m: Arithmetic, activation: Activation, degrees: Degrees) -> Degrees:
    """Return the degrees of the first `rules` rules that are above 0 and reach `threshold`, in the order written."""
    taken: Number = 0.0
    chosen = []
    for degree in degrees:
        fires = (degree > 0.0) & (degree >= activation.threshold) & (taken < activation.rules)
        chosen.append(m.where(fires, degree, nan))
        taken = taken + m.where(fires, 1.0, 0.0)
    return chosen


def last(m: Arithmetic, activation: Activation, degrees: Degrees) -> Degrees:
    """Return the degrees of the last `rules` rules that are above 0 and reach `threshold`."""
    return first(m, activation, degrees[::-1])[::-1]


def lowest(m: Arithmetic, activation: Activation, degrees: Degrees) -> Degrees:
    """Return the `rules` lowest degrees above 0; of equal ones, those written first."""
    ranks = m.rank([m.where(degree > 0.0, degree, inf) for degree in degrees])
    return _ranked(m, activation, ranks, degrees)


def highest(m: Arithmetic, activation: Activation, degrees: Degrees) -> Degrees:
    """Return the `rules` highest degrees above 0; of equal ones, those written first."""
    ranks = m.rank([-degree for degree in degrees])
    return _ranked(m, activation, ranks, degrees)


def _ranked(m: Arithmetic, activation: Activation, ranks: Degrees, degrees: Degrees) -> Degrees:
    return [
        m.where((rank < activation.rules) & (degree > 0.0), degree, nan)
        for rank, degree in zip(ranks, degrees, strict=True)
    ]


def proportional(m: Arithmetic, activation: Activation, degrees: Degrees) -> Degrees:
    """Return the degrees above 0, scaled so that they add up to 1."""
    whole = m.maximum(total(degrees), 1e-300)
    return [m.where(degree > 0.0, degree / whole, nan) for degree in degrees]


def threshold(m: Arithmetic, activation: Activation, degrees: Degrees) -> Degrees:
    """Return the degrees for which the comparison with `threshold` by the operator `comparison` is true."""
    compare = COMPARISON_FUNCTIONS[activation.comparison]
    return [m.where(compare(degree, activation.threshold), degree, nan) for degree in degrees]


ACTIVATE: Mapping[str, Callable[[Arithmetic, Activation, Degrees], Degrees]] = {
    "general": general,
    "first": first,
    "last": last,
    "highest": highest,
    "lowest": lowest,
    "proportional": proportional,
    "threshold": threshold,
}
