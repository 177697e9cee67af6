"""Membership functions: for each kind of term its formula, prepared once for its parameters.

The shapes and their edges are FuzzyLite's (Rada-Vilela, fuzzylite.com), with every vertical edge allowed. A prepared
function accepts x (a float or an array, depending on its arithmetic) and returns the membership before scaling by the
term's height.
"""

from collections.abc import Callable, Mapping
from math import inf, pi

from lumen.fuzzy.arithmetic import Arithmetic, Number
from lumen.fuzzy.formulas import formula
from lumen.language.controllers import Term

Membership = Callable[[Number], Number]

LEAST_DENOMINATOR = 1e-300
"""The least denominator, or argument of a logarithm; it is far below every membership that matters."""

MAX_EXPONENT = 700.0
"""The largest exponent: e^700 is still a float."""


def membership(m: Arithmetic, term: Term) -> Membership:
    """Return the membership function of a term, scaled to its height; `constant` and `linear` have none."""
    shape = (
        function(m, term.formula) if term.kind == "function" else MEMBERSHIP_FUNCTIONS[term.kind](m, *term.parameters)
    )
    if term.height == 1.0:
        return shape
    return lambda x: term.height * shape(x)


def function(m: Arithmetic, text: str) -> Membership:
    """Return a formula of x as a membership, clipped to 0 and 1; it is 0 if the formula has no value."""
    value = formula(m, text, ())

    def shape(x: Number) -> Number:
        found = value(x, ())
        return m.where(found == found, m.clamp(found, 0.0, 1.0), 0.0)

    return shape


def _rising(m: Arithmetic, start: float, end: float) -> Membership:
    """Return a ramp from 0 at `start` to 1 at `end`; a step if they are equal, and 1 if `start` is minus infinity."""
    if start == -inf:
        return lambda x: 1.0
    if end <= start:
        return lambda x: m.where(x >= start, 1.0, 0.0)
    slope = 1.0 / (end - start)
    return lambda x: m.clamp((x - start) * slope, 0.0, 1.0)


def _falling(m: Arithmetic, start: float, end: float) -> Membership:
    """Return a ramp from 1 at `start` to 0 at `end`; a step if they are equal, and 1 if `end` is infinite."""
    mirrored = _rising(m, -end, -start)
    return lambda x: mirrored(-x)


def triangle(m: Arithmetic, left: float, top: float, right: float) -> Membership:
    """Return a triangle with its corners at `left`, `top` and `right`."""
    return trapezoid(m, left, top, top, right)


def trapezoid(m: Arithmetic, a: float, b: float, c: float, d: float) -> Membership:
    """Return a trapezoid that rises from `a` to `b` and falls from `c` to `d`."""
    up, down = _rising(m, a, b), _falling(m, c, d)
    return lambda x: m.minimum(up(x), down(x))


def gaussian(m: Arithmetic, mean: float, sigma: float) -> Membership:
    """Return a Gaussian bell."""
    k, exp = -0.5 / (sigma * sigma), m.exp
    return lambda x: exp(k * (x - mean) * (x - mean))


def gaussian_product(m: Arithmetic, mean_a: float, sigma_a: float, mean_b: float, sigma_b: float) -> Membership:
    """Return the left half of one Gaussian bell times the right half of another; each is 1 on its other side."""
    a, b = gaussian(m, mean_a, sigma_a), gaussian(m, mean_b, sigma_b)
    return lambda x: a(m.minimum(x, mean_a)) * b(m.maximum(x, mean_b))


def bell(m: Arithmetic, center: float, width: float, slope: float) -> Membership:
    """Return a generalized bell: 1 / (1 + |(x - center) / width|^(2 slope))."""
    if slope == 0.0:
        return _half

    def shape(x: Number) -> Number:
        exponent = 2.0 * slope * m.log(m.maximum(m.abs((x - center) / width), LEAST_DENOMINATOR))
        return 1.0 / (1.0 + m.exp(m.clamp(exponent, -MAX_EXPONENT, MAX_EXPONENT)))

    return shape


def sigmoid(m: Arithmetic, inflection: float, slope: float) -> Membership:
    """Return a sigmoid, 1/2 at `inflection`; a negative `slope` makes it fall."""
    if slope == 0.0:
        return _half
    return lambda x: 1.0 / (1.0 + m.exp(m.clamp(slope * (inflection - x), -MAX_EXPONENT, MAX_EXPONENT)))


def _half(x: Number) -> Number:
    """Return one half, the value of a sigmoid without slope, also at infinity."""
    return 0.5


def sigmoid_difference(m: Arithmetic, left: float, rising: float, falling: float, right: float) -> Membership:
    """Return the absolute difference of two sigmoids."""
    a, b = sigmoid(m, left, rising), sigmoid(m, right, falling)
    return lambda x: m.abs(a(x) - b(x))


def sigmoid_product(m: Arithmetic, left: float, rising: float, falling: float, right: float) -> Membership:
    """Return the product of two sigmoids."""
    a, b = sigmoid(m, left, rising), sigmoid(m, right, falling)
    return lambda x: a(x) * b(x)


def ramp(m: Arithmetic, start: float, end: float) -> Membership:
    """Return a ramp from 0 at `start` to 1 at `end`, which may be on either side."""
    return _rising(m, start, end) if start < end else _falling(m, end, start)


def rectangle(m: Arithmetic, start: float, end: float) -> Membership:
    """Return 1 between `start` and `end`, both included."""
    low, high = min(start, end), max(start, end)
    return lambda x: m.where((low <= x) & (x <= high), 1.0, 0.0)


def s_shape(m: Arithmetic, start: float, end: float) -> Membership:
    """Return a smooth step up from `start` to `end`."""
    ramp = _rising(m, start, end)

    def shape(x: Number) -> Number:
        t = ramp(x)
        return m.where(t <= 0.5, 2.0 * t * t, 1.0 - 2.0 * (1.0 - t) * (1.0 - t))

    return shape


def z_shape(m: Arithmetic, start: float, end: float) -> Membership:
    """Return a smooth step down from `start` to `end`."""
    mirrored = s_shape(m, -end, -start)
    return lambda x: mirrored(-x)


def pi_shape(m: Arithmetic, a: float, b: float, c: float, d: float) -> Membership:
    """Return a smooth step up from `a` to `b` times a step down from `c` to `d`."""
    up, down = s_shape(m, a, b), z_shape(m, c, d)
    return lambda x: up(x) * down(x)


def spike(m: Arithmetic, center: float, width: float) -> Membership:
    """Return an exponential decay about `center` on both sides."""
    k = -10.0 / abs(width)
    return lambda x: m.exp(k * m.abs(x - center))


def cosine(m: Arithmetic, center: float, width: float) -> Membership:
    """Return one period of a cosine about `center`, `width` wide."""
    half = 0.5 * width
    return lambda x: 0.5 * (1.0 + m.cos(pi * m.clamp((x - center) / half, -1.0, 1.0)))


def concave(m: Arithmetic, inflection: float, end: float) -> Membership:
    """Return a concave curve that reaches 1 at `end`."""
    reach = end - inflection
    clip = m.minimum if reach >= 0 else m.maximum
    return lambda x: reach / (2.0 * end - inflection - clip(x, end))


def semi_ellipse(m: Arithmetic, start: float, end: float) -> Membership:
    """Return the upper half of an ellipse from `start` to `end`."""
    centre, radius = 0.5 * (start + end), 0.5 * abs(end - start)

    def shape(x: Number) -> Number:
        t = (x - centre) / radius
        return m.sqrt(m.maximum(1.0 - t * t, 0.0))

    return shape


def arc(m: Arithmetic, start: float, end: float) -> Membership:
    """Return a quarter of an ellipse from 0 at `start` to 1 at `end`."""
    quarter = ramp(m, start, end)

    def shape(x: Number) -> Number:
        t = 1.0 - quarter(x)
        return m.sqrt(m.maximum(1.0 - t * t, 0.0))

    return shape


def binary(m: Arithmetic, start: float, direction: float) -> Membership:
    """Return 1 from `start` on, towards the side on which `direction` is, else 0."""
    if direction > start:
        return lambda x: m.where(x >= start, 1.0, 0.0)
    return lambda x: m.where(x <= start, 1.0, 0.0)


def discrete(m: Arithmetic, *points: float) -> Membership:
    """Return the linear interpolation between points, given as x, y, x, y, …, with ascending x."""
    xs, ys = points[::2], points[1::2]
    return lambda x: m.interpolate(x, xs, ys)


MEMBERSHIP_FUNCTIONS: Mapping[str, Callable[..., Membership]] = {
    "triangle": triangle,
    "trapezoid": trapezoid,
    "gaussian": gaussian,
    "gaussian-product": gaussian_product,
    "bell": bell,
    "sigmoid": sigmoid,
    "sigmoid-difference": sigmoid_difference,
    "sigmoid-product": sigmoid_product,
    "ramp": ramp,
    "rectangle": rectangle,
    "s-shape": s_shape,
    "z-shape": z_shape,
    "pi-shape": pi_shape,
    "spike": spike,
    "cosine": cosine,
    "concave": concave,
    "semi-ellipse": semi_ellipse,
    "arc": arc,
    "binary": binary,
    "discrete": discrete,
}
