"""One arithmetic for numbers and one for arrays, so that every formula of the inference is written once.

`NUMBERS` works on Python floats and imports nothing; `arrays()` is the same on NumPy arrays. Both sides of `where` are
evaluated, so a formula keeps its denominators and roots in their domain on either side.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, reduce
from math import cos, exp, fabs, log, sqrt
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]
    """The values of a batch: one float for each row."""

Number = Any
"""A float, or an array of floats, depending on the arithmetic."""


@dataclass(frozen=True, slots=True)
class Arithmetic:
    """The operations of which memberships, hedges, norms and activations consist."""

    exp: Callable[[Number], Number]
    log: Callable[[Number], Number]
    sqrt: Callable[[Number], Number]
    cos: Callable[[Number], Number]
    abs: Callable[[Number], Number]
    minimum: Callable[[Number, Number], Number]
    maximum: Callable[[Number, Number], Number]
    where: Callable[[Any, Number, Number], Number]
    """Returns the second argument if the first is true, else the third, element by element."""
    interpolate: Callable[[Number, tuple[float, ...], tuple[float, ...]], Number]
    """Returns the value at x of the polyline through xs (ascending) and ys, constant beyond its ends."""
    rank: Callable[[list[Number]], list[Number]]
    """Returns the rank of each value from 0, element by element; equal values keep their order."""

    def clamp(self, x: Number, low: float, high: float) -> Number:
        """Return `x`, or the nearer end of [low, high] if it is outside."""
        return self.minimum(self.maximum(x, low), high)


def _interpolate(x: float, xs: tuple[float, ...], ys: tuple[float, ...]) -> float:
    if x < xs[0]:
        return ys[0]
    for x0, x1, y0, y1 in zip(xs, xs[1:], ys, ys[1:], strict=False):
        if x < x1:
            return y0 + (y1 - y0) * (x - x0) / (x1 - x0)
    return ys[-1]


def _rank(values: list[float]) -> list[float]:
    order = sorted(range(len(values)), key=lambda i: values[i])
    ranks = [0.0] * len(values)
    for rank, i in enumerate(order):
        ranks[i] = float(rank)
    return ranks


NUMBERS = Arithmetic(
    exp=exp,
    log=log,
    sqrt=sqrt,
    cos=cos,
    abs=fabs,
    minimum=lambda a, b: a if a < b else b,
    maximum=lambda a, b: a if a > b else b,
    where=lambda condition, a, b: a if condition else b,
    interpolate=_interpolate,
    rank=_rank,
)


@cache
def arrays() -> Arithmetic:
    """Return the arithmetic of NumPy arrays; the first call imports NumPy."""
    import numpy as np

    def rank(values: list[Number]) -> list[Number]:
        stacked = np.stack(np.broadcast_arrays(*values))
        return list(stacked.argsort(axis=0, kind="stable").argsort(axis=0))

    return Arithmetic(
        exp=np.exp,
        log=np.log,
        sqrt=np.sqrt,
        cos=np.cos,
        abs=np.abs,
        minimum=np.minimum,
        maximum=np.maximum,
        where=np.where,
        interpolate=np.interp,
        rank=rank,
    )


def total(values: list[Number]) -> Number:
    """Return the sum of numbers or of arrays; 0 of an empty list."""
    return reduce(lambda a, b: a + b, values, 0.0)
