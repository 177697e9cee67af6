"""The centroid of clipped terms under their maximum, exact for the sampled set, but without evaluating its points.

With minimum as implication and maximum as aggregation, the concluded set is max over k of min(d_k, M_k(y)). Cut the set
into layers between the sorted degrees: exactly the m terms with the greatest degrees contribute to the layer below the
m-th greatest degree, so its area is F_S(top) - F_S(bottom), where S are these terms, M_S their maximum and

    F_S(t) = sum over the points y of min(t, M_S(y)),

and likewise for the moment. F_S is piecewise linear in t, with a corner at each sampled membership: once the
memberships are sorted and summed up, one bisection evaluates F_S. So the cost grows with the logarithm of the number of
points.
"""

from bisect import bisect_left
from collections.abc import Sequence
from itertools import accumulate
from math import nan
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from lumen.fuzzy.arithmetic import Array

MAX_LAYERED_TERMS = 6
"""The greatest number of terms: a layer is kept for every union of terms that occurs, so at most 2^6."""

_BINS = 1 << 14  # bins of the degrees' range, by which a batch finds most layers without a search


class Layer:
    """F_S(t) and its first moment for one union of terms.

    `offsets` are the distances of the points from the middle of the range, and `memberships` those of M_S at the
    points.
    """

    def __init__(self, offsets: Sequence[float], memberships: Sequence[float]) -> None:
        pairs = sorted(zip(memberships, offsets, strict=True))
        self.levels = [level for level, _ in pairs]
        self.area = [0.0, *accumulate(self.levels)]
        self.moment = [0.0, *accumulate(level * offset for level, offset in pairs)]
        self.count = [float(n) for n in range(len(pairs), -1, -1)]
        self.above = [*accumulate((offset for _, offset in reversed(pairs)), initial=0.0)][::-1]

    def measure(self, t: float) -> tuple[float, float]:
        """Return area and moment under the level `t`, as sums over the points."""
        i = bisect_left(self.levels, t)
        return self.area[i] + t * self.count[i], self.moment[i] + t * self.above[i]


class LayeredCentroid:
    """Defuzzifies by centroid; `terms` is the index of the term that each of the degrees given later clips.

    The `points` ascend, and `memberships` has those of each term at them.
    """

    def __init__(self, points: Sequence[float], memberships: Sequence[Sequence[float]], terms: Sequence[int]) -> None:
        self._middle = (points[0] + points[-1]) / 2
        self._offsets = [y - self._middle for y in points]
        self._memberships = memberships
        self._terms = terms
        self._layers: dict[int, Layer] = {}
        self._tables: dict[int, _Table] = {}

    def crisp(self, degrees: Sequence[float], values: Sequence[float] = ()) -> float:
        """Return the centroid; NaN if no term is clipped above zero."""
        area = moment = 0.0
        ordered = sorted(zip(degrees, self._terms, strict=True), reverse=True)
        last, union = len(ordered), 0
        for i, (top, term) in enumerate(ordered, 1):
            union |= 1 << term
            bottom = ordered[i][0] if i < last else 0.0
            if top > bottom:
                layer = self._layers.get(union) or self._layer(union)
                a, b = layer.measure(top)
                if bottom > 0.0:
                    c, d = layer.measure(bottom)
                    a, b = a - c, b - d
                area += a
                moment += b
        return self._middle + moment / area if area > 0.0 else nan

    def crisp_batch(self, degrees: "Sequence[Array]", values: "Sequence[Array]" = ()) -> "Array":
        """Return the centroids, Shape (n,), of degrees of Shape (n,) each; NaN if no term is clipped above zero."""
        import numpy as np

        clips = self._by_term(degrees)
        area, moment = np.zeros((2, len(degrees[0])))
        for union in range(1, 1 << len(clips)):
            inside = [clip for k, clip in enumerate(clips.values()) if union >> k & 1]
            outside = [clip for k, clip in enumerate(clips.values()) if not union >> k & 1]
            top = np.minimum.reduce(inside)
            bottom = np.maximum.reduce(outside) if outside else np.zeros_like(top)
            rows = np.flatnonzero(top > bottom)
            if rows.size:
                table = self._table(sum(1 << term for k, term in enumerate(clips) if union >> k & 1))
                for sign, level in ((1.0, top), (-1.0, bottom)):
                    a, b = table.measure(level[rows])
                    area[rows] += sign * a
                    moment[rows] += sign * b
        with np.errstate(invalid="ignore", divide="ignore"):
            return np.where(area > 0.0, self._middle + moment / area, nan)

    def _by_term(self, degrees: "Sequence[Array]") -> "dict[int, Array]":
        import numpy as np

        clips: dict[int, Array] = {}
        for term, degree in zip(self._terms, degrees, strict=True):
            clips[term] = np.maximum(clips[term], degree) if term in clips else degree
        return clips

    def _layer(self, union: int) -> Layer:
        parts = [m for k, m in enumerate(self._memberships) if union >> k & 1]
        self._layers[union] = layer = Layer(self._offsets, [max(column) for column in zip(*parts, strict=True)])
        return layer

    def _table(self, union: int) -> "_Table":
        if union not in self._tables:
            self._tables[union] = _Table(self._layers.get(union) or self._layer(union))
        return self._tables[union]


class _Table:
    """A layer for arrays of levels."""

    def __init__(self, layer: Layer) -> None:
        import numpy as np

        self.levels = np.array(layer.levels)
        self.pieces = np.array([layer.area, layer.count, layer.moment, layer.above]).T.copy()
        edges = np.searchsorted(self.levels, np.arange(_BINS + 1) / _BINS)
        self.first = edges.astype(np.intp)
        self.sure = np.append(edges[:-1] == edges[1:], False)  # an unbounded sum may exceed 1

    def measure(self, t: "Array") -> "tuple[Array, Array]":
        """Return area and moment under each level; only levels in a bin with a corner need a search."""
        import numpy as np

        bins = np.minimum(t * _BINS, _BINS).astype(np.intp)
        index = self.first[bins]
        unsure = np.flatnonzero(~self.sure[bins])
        index[unsure] = np.searchsorted(self.levels, t[unsure])
        piece = self.pieces[index]
        return piece[:, 0] + t * piece[:, 1], piece[:, 2] + t * piece[:, 3]
