"""Weighted defuzzifiers: a Takagi-Sugeno term has a value, a Tsukamoto term is inverted."""

from collections.abc import Callable, Mapping, Sequence
from functools import reduce
from math import nan
from typing import TYPE_CHECKING

from lumen.fuzzy.arithmetic import NUMBERS, Arithmetic, Number, arrays, total
from lumen.fuzzy.formulas import formula
from lumen.fuzzy.norms import norm
from lumen.language.controllers import Term

if TYPE_CHECKING:
    from lumen.fuzzy.arithmetic import Array

TermValue = Callable[[Number, Sequence[Number]], Number]
"""Returns a term's value at a degree, given the values of the controller's variables."""

_TINY = 1e-300


def _concave(m: Arithmetic, h: float, i: float, e: float) -> Callable[[Number], Number]:
    return lambda w: h * (i - e) / m.maximum(w, _TINY) + 2.0 * e - i


def _sigmoid(m: Arithmetic, h: float, i: float, s: float) -> Callable[[Number], Number]:
    steep = 1.0 / s if s else nan

    def value(w: Number) -> Number:
        rest = h / m.maximum(w, _TINY) - 1.0
        return m.where(rest > 0.0, i - m.log(m.maximum(rest, _TINY)) * steep, nan)

    return value


def _s_shape(m: Arithmetic, h: float, s: float, e: float) -> Callable[[Number], Number]:
    def value(w: Number) -> Number:
        low, high = m.sqrt(w / (2.0 * h)), m.sqrt(m.maximum(h - w, 0.0) / (2.0 * h))
        return m.where(w > h, nan, m.where(w <= h / 2.0, s + (e - s) * low, e - (e - s) * high))

    return value


def _arc(m: Arithmetic, h: float, s: float, e: float) -> Callable[[Number], Number]:
    r = e - s
    return lambda w: m.where(w > h, nan, e - r * m.sqrt(m.maximum(1.0 - (w / h) * (w / h), 0.0)))


INVERSE_MEMBERSHIPS: Mapping[str, Callable[..., Callable[[Number], Number]]] = {
    "ramp": lambda m, h, s, e: lambda w: s + (e - s) * w / h,
    "sigmoid": _sigmoid,
    "s-shape": _s_shape,
    "z-shape": lambda m, h, s, e: _s_shape(m, h, e, s),
    "concave": _concave,
    "arc": _arc,
}
"""For each monotonic kind the x at which the membership is w, from the term's height and parameters.

It is NaN if no x has that membership, as for w above the height; ramps and `concave` continue beyond the height.
"""


def value(m: Arithmetic, term: Term, names: Sequence[str] = (), inputs: int = 0) -> TermValue:
    """Return a function for the value of a term of kind `constant`, `linear`, `function` or a monotonic kind.

    Its arguments are the degree and the values of the variables `names`, of which the first `inputs` are the
    controller's inputs.
    """
    if term.kind == "constant":
        return lambda w, values: term.parameters[0]
    if term.kind == "linear":
        return lambda w, values: _line(term.parameters, values[:inputs])
    if term.kind == "function":
        return formula(m, term.formula, names)
    inverse = INVERSE_MEMBERSHIPS[term.kind](m, term.height, *term.parameters)
    return lambda w, values: inverse(w)


def _line(coefficients: tuple[float, ...], inputs: Sequence[Number]) -> Number:
    products = [k * x for k, x in zip(coefficients, inputs, strict=False)]
    return total([*products, *coefficients[len(inputs) :]])


class Weighted:
    """Defuzzifies by weighted average or sum.

    `which` has the index of the term of each degree that is given later. The values given later are those of the
    variables `names`, of which the first `inputs` are the controller's inputs.
    """

    def __init__(
        self,
        terms: Sequence[Term],
        which: Sequence[int],
        aggregation: str,
        average: bool,
        names: Sequence[str] = (),
        inputs: int = 0,
    ) -> None:
        self._terms, self._which, self._aggregation, self._average = terms, which, aggregation, average
        self._names, self._inputs = names, inputs
        self._on_numbers = [value(NUMBERS, term, names, inputs) for term in terms]
        self._on_arrays: list[TermValue] = []

    def crisp(self, degrees: Sequence[float], values: Sequence[float]) -> float:
        """Return the output; NaN if no term has a weight, or a formula has no value."""
        return float(self._crisp(NUMBERS, self._on_numbers, degrees, values))

    def crisp_batch(self, degrees: "Sequence[Array]", values: "Sequence[Array]") -> "Array":
        """Return the outputs, Shape (n,), of degrees of Shape (n,) each.

        An output is NaN if no term has a weight, or a formula has no value.
        """
        self._on_arrays = self._on_arrays or [value(arrays(), term, self._names, self._inputs) for term in self._terms]
        return self._crisp(arrays(), self._on_arrays, degrees, values)  # type: ignore[no-any-return]

    def _crisp(
        self, m: Arithmetic, terms: list[TermValue], degrees: Sequence[Number], values: Sequence[Number]
    ) -> Number:
        by_term = self._weights(m, degrees)
        whole = total(list(by_term.values()))
        some = whole > 0.0
        sums = total([m.where(w > 0.0, w * terms[k](w, values), 0.0) for k, w in by_term.items()])
        return m.where(some, sums / m.where(some, whole, 1.0) if self._average else sums, nan)

    def _weights(self, m: Arithmetic, degrees: Sequence[Number]) -> dict[int, Number]:
        by_term: dict[int, list[Number]] = {}
        for term, degree in zip(self._which, degrees, strict=True):
            by_term.setdefault(term, []).append(degree)
        return {term: reduce(norm(m, self._aggregation), found) for term, found in by_term.items()}
