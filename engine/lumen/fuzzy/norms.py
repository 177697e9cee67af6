"""T-norms and S-norms: they combine two degrees by `and`, `or`, implication and aggregation.

An unbounded sum may pass more than 1 to another norm; even then no denominator is zero.
"""

from collections.abc import Callable, Mapping

from lumen.fuzzy.arithmetic import Arithmetic, Number

Norm = Callable[[Arithmetic, Number, Number], Number]

_TINY = 1e-300  # keeps the denominator above zero if the other side of `where` is the result


def _drastic_product(m: Arithmetic, a: Number, b: Number) -> Number:
    return m.where(m.maximum(a, b) == 1.0, m.minimum(a, b), 0.0)


def _einstein_product(m: Arithmetic, a: Number, b: Number) -> Number:
    return a * b / m.maximum(2.0 - (a + b - a * b), _TINY)


def _hamacher_product(m: Arithmetic, a: Number, b: Number) -> Number:
    return a * b / m.maximum(a + b - a * b, _TINY)


def _nilpotent_minimum(m: Arithmetic, a: Number, b: Number) -> Number:
    return m.where(a + b > 1.0, m.minimum(a, b), 0.0)


def _drastic_sum(m: Arithmetic, a: Number, b: Number) -> Number:
    return m.where(m.minimum(a, b) == 0.0, m.maximum(a, b), 1.0)


def _hamacher_sum(m: Arithmetic, a: Number, b: Number) -> Number:
    rest = 1.0 - a * b  # (a + b - 2ab) / rest, written so that no digits cancel near 1
    return 1.0 - (1.0 - a) * (1.0 - b) / m.where(rest == 0.0, 1.0, rest)


def _nilpotent_maximum(m: Arithmetic, a: Number, b: Number) -> Number:
    return m.where(a + b < 1.0, m.maximum(a, b), 1.0)


NORM_FUNCTIONS: Mapping[str, Norm] = {
    "minimum": lambda m, a, b: m.minimum(a, b),
    "algebraic-product": lambda m, a, b: a * b,
    "bounded-difference": lambda m, a, b: m.maximum(a + b - 1.0, 0.0),
    "drastic-product": _drastic_product,
    "einstein-product": _einstein_product,
    "hamacher-product": _hamacher_product,
    "nilpotent-minimum": _nilpotent_minimum,
    "maximum": lambda m, a, b: m.maximum(a, b),
    "algebraic-sum": lambda m, a, b: a + b - a * b,
    "bounded-sum": lambda m, a, b: m.minimum(a + b, 1.0),
    "drastic-sum": _drastic_sum,
    "einstein-sum": lambda m, a, b: (a + b) / (1.0 + a * b),
    "hamacher-sum": _hamacher_sum,
    "nilpotent-maximum": _nilpotent_maximum,
    "normalized-sum": lambda m, a, b: (a + b) / m.maximum(a + b, 1.0),
    "unbounded-sum": lambda m, a, b: a + b,
}


def norm(m: Arithmetic, name: str) -> Callable[[Number, Number], Number]:
    """Return the norm of that name on numbers or arrays."""
    if name == "minimum":
        return m.minimum
    if name == "maximum":
        return m.maximum
    function = NORM_FUNCTIONS[name]
    return lambda a, b: function(m, a, b)
