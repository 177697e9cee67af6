"""From the degrees of an output's conclusions to its value, by the cheapest way that is exact."""

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
    """Degrees of an output's conclusions to its value; NaN where nothing fires."""

    def crisp(self, degrees: list[float], values: list[float]) -> float: ...

    def crisp_batch(self, degrees: "list[Array]", values: "list[Array]") -> "Array": ...


def defuzzifier(
    variable: Variable, conclusions: list[Conclusion], known: Sequence[str] = (), inputs: int = 0
) -> Defuzzifier:
    """The cheapest defuzzifier that is exact for what the rules conclude about an output.

    It is handed, beside the degrees, the values of the variables called `known`; the first `inputs` are the inputs.
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
    """The points at which an output's set is sampled: the middles of `resolution` equal parts of its range.

    The top of a set that lies between two of them, such as a single point, is added.
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
    """A term's memberships at these points."""
    shape = membership(NUMBERS, term)
    return [float(shape(y)) for y in points]
