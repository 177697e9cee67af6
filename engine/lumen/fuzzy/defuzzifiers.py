"""Defuzzification of the degrees of an output's conclusions, by the cheapest method that is exact."""

from bisect import bisect_left
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Protocol

from lumen.fuzzy.arithmetic import NUMBERS
from lumen.fuzzy.layers import MAX_LAYERED_TERMS, LayeredCentroid
from lumen.fuzzy.memberships import membership
from lumen.fuzzy.program import Conclusion
from lumen.fuzzy.weighted import Weighted
from lumen.language.controllers import VALUE_TERMS, Term, Variable

if TYPE_CHECKING:
    from lumen.fuzzy.arithmetic import Array
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

from lumen.fuzzy.arithmetic import arrays
from lumen.fuzzy.norms import norm

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from lumen.fuzzy.arithmetic import Array

_ROOM = 1 << 18  # values of a chunk: few enough for the cache


class Sampled:
    """Defuzzifies a sampled set by `method`, with NumPy.

    `memberships` are those of each term at the `points`. `terms` is, for each of the degrees given later, the index of
    the term that it implies, and `implications` the norm by which it does.
    """

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
        """Return the output for one degree of each conclusion; NaN if the set is empty."""
        import numpy as np

        return float(self.crisp_batch([np.array([degree]) for degree in degrees])[0])

    def crisp_batch(self, degrees: "Sequence[Array]", values: "Sequence[Array]" = ()) -> "Array":
        """Return the outputs, Shape (n,), of degrees of Shape (n,) each; NaN for empty sets."""
        import numpy as np

        size = max(1, _ROOM // len(self._points))
        chunks = range(0, len(degrees[0]), size)
        return np.concatenate([self._chunk([degree[i : i + size] for degree in degrees]) for i in chunks])

    def aggregated(self, degrees: "Sequence[Array]") -> "Array":
        """Return the aggregated set, Shape (n, points), for degrees of Shape (n,) each."""
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
    """Return the point that halves the area; of equally near points, their mean."""
    import numpy as np

    half = whole.cumsum(axis=1)
    off = abs(half / half[:, -1:] - 0.5)
    found = _mean(y, off == off.min(axis=1, keepdims=True))
    within = whole > 0.0
    return np.where(within.sum(axis=1) == 1, within @ y, found)  # a single point has no area on either side


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


class Defuzzifier(Protocol):
    """Converts the degrees of an output's conclusions to its value; NaN if no rule fires."""

    def crisp(self, degrees: list[float], values: list[float]) -> float:
        """Return the value for one degree of each conclusion, and the values of the known variables."""
        ...

    def crisp_batch(self, degrees: "list[Array]", values: "list[Array]") -> "Array":
        """Return the values, Shape (n,), for degrees and known variables of Shape (n,) each."""
        ...


def defuzzifier(
    variable: Variable, conclusions: list[Conclusion], known: Sequence[str] = (), inputs: int = 0
) -> Defuzzifier:
    """Return the cheapest defuzzifier that is exact for the rules' conclusions about an output.

    Besides the degrees, it receives the values of the variables `known`, the first `inputs` of which are the
    controller's inputs.
    """
    names = list(dict.fromkeys(conclusion.term for conclusion in conclusions))
    which = [names.index(conclusion.term) for conclusion in conclusions]
    terms = [variable.terms[name] for name in names]
    if variable.weighted:
        average = variable.defuzzifier == "weighted-average"
        return Weighted(terms, which, variable.aggregation, average, known, inputs)
    points = midpoints(variable)
    memberships = [sampled(term, points) for term in terms]
    implications = [conclusion.implication for conclusion in conclusions]
    clipped = set(implications) <= {"minimum"} and variable.aggregation == "maximum"
    if clipped and variable.defuzzifier == "centroid" and len(terms) <= MAX_LAYERED_TERMS:
        return LayeredCentroid(points, memberships, which)
    return Sampled(points, memberships, which, implications, variable.aggregation, variable.defuzzifier)


def midpoints(variable: Variable) -> list[float]:
    """Return the points at which an output's set is sampled: the middles of `resolution` equal parts of its range.

    If the top of a narrow term lies between two of them, it is added. The points ascend.
    """
    step = (variable.maximum - variable.minimum) / variable.resolution
    points = [variable.minimum + (i + 0.5) * step for i in range(variable.resolution)]
    slim = {top for term in variable.terms.values() for top in _between(term, points, variable)}
    return sorted({*points, *slim}) if slim else points


def _between(term: Term, points: list[float], variable: Variable) -> Iterator[float]:
    """Yield the corners at which a term is above 0, if it is 0 at the sampled points next to them."""
    if term.kind in (*VALUE_TERMS, "function"):
        return
    shape = membership(NUMBERS, term)
    for x in term.parameters[:: 2 if term.kind == "discrete" else 1]:
        if variable.minimum <= x <= variable.maximum and shape(x) > 0.0:
            i = bisect_left(points, x)
            if not any(shape(y) > 0.0 for y in points[max(i - 1, 0) : i + 1]):
                yield x


def sampled(term: Term, points: list[float]) -> list[float]:
    """Return a term's memberships at these points."""
    shape = membership(NUMBERS, term)
    return [float(shape(y)) for y in points]
