"""Defuzzify the degrees of an output's conclusions by the cheapest method that is exact."""

from bisect import bisect_left
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Protocol

from lumen.fuzzy.arithmetic import NUMBERS
from lumen.fuzzy.layers import MAX_LAYERED_TERMS, LayeredCentroid
from lumen.fuzzy.memberships import membership
from lumen.fuzzy.program import Conclusion
from lumen.fuzzy.sampled import Sampled
from lumen.fuzzy.weighted import Weighted
from lumen.language.controllers import VALUE_TERMS, Term, Variable

if TYPE_CHECKING:
    from lumen.fuzzy.arithmetic import Array


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

    Besides the degrees, it gets the values of the variables called `known`, the first `inputs` of which are inputs.
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

    If the top of a set lies between two of them, as that of a single point may, it is added.
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
