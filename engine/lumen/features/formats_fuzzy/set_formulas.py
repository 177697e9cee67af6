"""Converts MATLAB's and Octave's sets to formulas of x, from which complements and powers are derived."""

from collections.abc import Callable, Mapping


def set_formula(kind: str, parameters: list[float]) -> str:
    """Return a term's membership at x as a formula for `function`, or empty for a term that is a value."""
    make = _FORMULAS.get(kind)
    return make(*parameters) if make else ""


def _n(value: float) -> str:
    return f"({value!r})" if value < 0 else repr(value)


def _up(a: float, b: float) -> str:
    """Return a formula that is 0 up to a, 1 from b on, and linear between; if a is not below b, it steps at b."""
    return f"max(min((x - {_n(a)}) / {_n(b - a)}, 1), 0)" if a < b else f"(x >= {_n(b)} ? 1 : 0)"


def _down(c: float, d: float) -> str:
    return f"max(min(({_n(d)} - x) / {_n(d - c)}, 1), 0)" if c < d else f"(x <= {_n(c)} ? 1 : 0)"


def _trapezoid(a: float, b: float, c: float, d: float) -> str:
    return f"min({_up(a, b)}, {_down(c, d)})"


def _gaussian(mean: float, sigma: float) -> str:
    return f"exp(-(x - {_n(mean)}) * (x - {_n(mean)}) / {_n(2 * sigma * sigma)})"


def _two_gaussians(left: float, rise: float, right: float, fall: float) -> str:
    up, down = _gaussian(left, rise), _gaussian(right, fall)
    return f"(x < {_n(left)} ? {up} : 1) * (x > {_n(right)} ? {down} : 1)"


def _bell(center: float, width: float, slope: float) -> str:
    return f"1 / (1 + pow(abs((x - {_n(center)}) / {_n(width)}), {_n(2 * slope)}))"


def _sigmoid(inflection: float, slope: float) -> str:
    return f"1 / (1 + exp(max(min({_n(slope)} * ({_n(inflection)} - x), 700), -700)))"


def _s_shape(a: float, b: float) -> str:
    t = _up(a, b)
    return f"({t} <= 0.5 ? 2 * {t} * {t} : 1 - 2 * (1 - {t}) * (1 - {t}))"


def _z_shape(a: float, b: float) -> str:
    return f"(1 - {_s_shape(a, b)})"


_FORMULAS: Mapping[str, Callable[..., str]] = {
    "triangle": lambda a, b, c: _trapezoid(a, b, b, c),
    "trapezoid": _trapezoid,
    "ramp": lambda a, b: _up(a, b) if a < b else _down(b, a),
    "gaussian": _gaussian,
    "gaussian-product": _two_gaussians,
    "bell": _bell,
    "sigmoid": _sigmoid,
    "sigmoid-difference": lambda i, s, t, j: f"abs({_sigmoid(i, s)} - {_sigmoid(j, t)})",
    "sigmoid-product": lambda i, s, t, j: f"({_sigmoid(i, s)}) * ({_sigmoid(j, t)})",
    "s-shape": _s_shape,
    "z-shape": _z_shape,
    "pi-shape": lambda a, b, c, d: f"{_s_shape(a, b)} * {_z_shape(c, d)}",
}
