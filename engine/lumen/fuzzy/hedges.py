"""Hedges: words that change a degree, as in `very Near`."""

from collections.abc import Callable, Mapping

from lumen.fuzzy.arithmetic import Arithmetic, Number


def _extremely(m: Arithmetic, x: Number) -> Number:
    return m.where(x <= 0.5, 2.0 * x * x, 1.0 - 2.0 * (1.0 - x) * (1.0 - x))


def _seldom(m: Arithmetic, x: Number) -> Number:
    low, high = m.sqrt(m.maximum(0.5 * x, 0.0)), m.sqrt(m.maximum(0.5 * (1.0 - x), 0.0))
    return m.where(x <= 0.5, low, 1.0 - high)


HEDGE_FUNCTIONS: Mapping[str, Callable[[Arithmetic, Number], Number]] = {
    "any": lambda m, x: 1.0,
    "not": lambda m, x: m.maximum(1.0 - x, 0.0),
    "extremely": _extremely,
    "seldom": _seldom,
    "somewhat": lambda m, x: m.sqrt(m.maximum(x, 0.0)),
    "very": lambda m, x: x * x,
}


def hedged(m: Arithmetic, hedges: tuple[str, ...], degree: Number) -> Number:
    """The degree after its hedges; the one next to the term acts first."""
    for hedge in reversed(hedges):
        degree = HEDGE_FUNCTIONS[hedge](m, degree)
    return degree
