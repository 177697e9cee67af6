"""Defuzzification of a sampled set, for every norm: the general method, point by point."""

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING

from lumen.fuzzy.arithmetic import arrays
from lumen.fuzzy.norms import norm

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from lumen.fuzzy.arithmetic import Array

_ROOM = 1 << 18  # values of a chunk: small enough for the cache


class Sampled:
    """Defuzzifies by `method`; `terms` is the index of the term that each of the given degrees implies."""

    def __init__(
        self,
        points: Sequence[float],
        memberships: Sequence[Sequence[float]],
        terms: Sequence[int],
        implications: Sequence[str],
        aggregation: str,
        method: str,
    ) -> None:
        import numpy as np

        self._points = np.array(points)
        self._memberships = np.array(memberships)
        self._terms = terms
        self._implications = [norm(arrays(), name) for name in implications]
        self._aggregation = norm(arrays(), aggregation)
        self._method = DEFUZZIFY[method]

    def crisp(self, degrees: Sequence[float], values: Sequence[float] = ()) -> float:
        """Return the output; NaN if the set is empty."""
        import numpy as np

        return float(self.crisp_batch([np.array([degree]) for degree in degrees])[0])

    def crisp_batch(self, degrees: "Sequence[Array]", values: "Sequence[Array]" = ()) -> "Array":
        """Return the outputs, Shape (n,), of degrees of Shape (n,) each; NaN for empty sets."""
        import numpy as np

        size = max(1, _ROOM // len(self._points))
        chunks = range(0, len(degrees[0]), size)
        return np.concatenate([self._chunk([degree[i : i + size] for degree in degrees]) for i in chunks])

    def aggregated(self, degrees: "Sequence[Array]") -> "Array":
        """Return the concluded set, Shape (n, points)."""
        import numpy as np

        whole = np.zeros((len(degrees[0]), len(self._points)))
        for degree, term, implication in zip(degrees, self._terms, self._implications, strict=True):
            whole = self._aggregation(whole, implication(degree[:, None], self._memberships[term]))
        return whole

    def _chunk(self, degrees: "Sequence[Array]") -> "Array":
        import numpy as np

        whole = self.aggregated(degrees)
        fired = whole.max(axis=1) > 0.0
        return np.where(fired, self._method(self._points, np.where(fired[:, None], whole, 1.0)), np.nan)


def _centroid(y: "Array", whole: "Array") -> "Array":
    return (whole @ y) / whole.sum(axis=1)  # type: ignore[no-any-return]


def _bisector(y: "Array", whole: "Array") -> "Array":
    """Return the point that halves the area; the mean of all points that are equally near to it."""
    import numpy as np

    half = whole.cumsum(axis=1)
    off = abs(half / half[:, -1:] - 0.5)
    found = _mean(y, off == off.min(axis=1, keepdims=True))
    within = whole > 0.0
    return np.where(within.sum(axis=1) == 1, within @ y, found)  # a single point has no area beside it


def _mean(y: "Array", chosen: "NDArray[np.bool_]") -> "Array":
    return (chosen @ y) / chosen.sum(axis=1)  # type: ignore[no-any-return]


def _highest(whole: "Array") -> "NDArray[np.bool_]":
    return whole == whole.max(axis=1, keepdims=True)  # type: ignore[no-any-return]


DEFUZZIFY: Mapping[str, "Callable[[Array, Array], Array]"] = {
    "centroid": _centroid,
    "bisector": _bisector,
    "smallest-of-maximum": lambda y, whole: y[_highest(whole).argmax(axis=1)],
    "mean-of-maximum": lambda y, whole: _mean(y, _highest(whole)),
    "largest-of-maximum": lambda y, whole: y[len(y) - 1 - _highest(whole)[:, ::-1].argmax(axis=1)],
}
