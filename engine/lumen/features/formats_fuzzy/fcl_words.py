"""Translates the keywords of Fuzzy Control Language (the standard, jFuzzyLogic and FuzzyLite) to Lumen's.

If only `AND` or `OR` is set, it determines the other by De Morgan's laws (IEC 61131-7). jFuzzyLogic pairs HAMACHER and
EINSTEIN.
"""

import re
from collections.abc import Mapping

from lumen.features.formats_fuzzy.fll.fuzzylite_names import SHAPES
from lumen.features.formats_fuzzy.fll.infix_formulas import Trouble, read_formula
from lumen.language.controllers import TERM_PARAMETERS

NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"

_MIN, _MAX = ("minimum", "maximum"), ("maximum", "minimum")
_PROD, _ASUM = ("algebraic-product", "algebraic-sum"), ("algebraic-sum", "algebraic-product")
_BDIF, _BSUM = ("bounded-difference", "bounded-sum"), ("bounded-sum", "bounded-difference")
_DMIN, _DMAX = ("drastic-product", "drastic-sum"), ("drastic-sum", "drastic-product")
_NMIN, _NMAX = ("nilpotent-minimum", "nilpotent-maximum"), ("nilpotent-maximum", "nilpotent-minimum")

ANDS: Mapping[str, tuple[str, str]] = {
    "min": _MIN, "prod": _PROD, "bdif": _BDIF, "dmin": _DMIN, "dprod": _DMIN, "nipmin": _NMIN, "nmin": _NMIN,
    "hamacher": ("hamacher-product", "einstein-sum"), "hprod": ("hamacher-product", "hamacher-sum"),
    "eprod": ("einstein-product", "einstein-sum"),
}  # fmt: skip
ORS: Mapping[str, tuple[str, str]] = {
    "max": _MAX, "asum": _ASUM, "bsum": _BSUM, "dmax": _DMAX, "dsum": _DMAX, "nipmax": _NMAX, "nmax": _NMAX,
    "einstein": ("einstein-sum", "hamacher-product"), "hsum": ("hamacher-sum", "hamacher-product"),
    "esum": ("einstein-sum", "einstein-product"),
}  # fmt: skip
"""Lumen's operator for each keyword, and the matching operator if only one of AND and OR is set."""

ACTS: Mapping[str, str] = {word: meant for word, (meant, _) in ANDS.items()}
ACCUS: Mapping[str, str] = {
    **{word: meant for word, (meant, _) in ORS.items()},
    "nsum": "normalized-sum",
    "sum": "unbounded-sum",
    "probor": "algebraic-sum",
}
METHODS = {"cog": "centroid", "cogs": "weighted-average", "cogf": "weighted-average", "coa": "bisector",
           "lm": "smallest-of-maximum", "rm": "largest-of-maximum", "mm": "mean-of-maximum"}  # fmt: skip

_KINDS = {
    "trian": "triangle", "trape": "trapezoid", "gauss": "gaussian", "gauss2": "gaussian-product", "gbell": "bell",
    "sigm": "sigmoid", "dsigm": "sigmoid-difference",
    **{name.lower(): kind for name, kind in SHAPES.items() if kind not in ("function", "linear")},
}  # fmt: skip


def shape(said: str) -> tuple[str, list[float] | str] | None:
    """Return a term's kind, and its parameters in Lumen's order or its formula; None if it can't be read.

    jFuzzyLogic's shapes have its order of parameters. `Cosine` in mixed case is FuzzyLite's.
    """
    words = said.split()
    kind = _KINDS.get(words[0].lower(), "") if words else ""
    numbers = [float(word) for word in words[1:] if re.fullmatch(NUMBER, word)]
    if not kind or len(numbers) != len(words) - 1:
        return None
    match words[0].lower(), numbers:
        case "gbell", [a, b, mean]:
            return kind, [mean, a, b]
        case "sigm", [gain, inflection]:
            return kind, [inflection, gain]
        case "cosine", [half, offset] if words[0] != "Cosine":
            return kind, [offset, 2 * half]
        case "dsigm", [rise, left, fall, right] if rise == fall > 0 and left <= right:
            return kind, [left, rise, fall, right]
        case "dsigm", [rise, left, fall, right]:
            return "function", f"max({_sigmoid(rise, left)} - {_sigmoid(fall, right)}, 0)"
    return kind, numbers


def _sigmoid(slope: float, inflection: float) -> str:
    return f"1 / (1 + exp(({slope!r}) * (({inflection!r}) - x)))"


def function(text: str, names: Mapping[str, str]) -> str | Trouble:
    """Translate jFuzzyLogic's `FUNCTION` to a Lumen formula, or return the problem in it.

    `names` maps the file's inputs to Lumen's. Formulas whose order of operations is unusual in FCL (`a % b * c`,
    `2 ^ 3 ^ 2`, `-2 ^ 2`) are rejected, and so is `x`, unless it is an input.
    """
    doubtful = text.count("^") > 1 or ("%" in text and re.search(r"[*/^]|%.*%", text))
    if doubtful or ("^" in text and re.search(r"[-+][\d.]", text)):
        return Trouble("signs, `^` and `%` have a different precedence in FCL", 0)
    if re.search(r"(?i)\bx\b", text) and "x" not in names:
        return Trouble("unknown name `x`", 0)
    theirs = re.sub(r"(?i)\b(exp|ln|log|sin|cos|tan|abs)(?=\s*\()", lambda match: match[1].lower(), text)
    theirs = re.sub(r"\b(ln|log)(?=\s*\()", lambda match: "log" if match[1] == "ln" else "log10", theirs)
    return read_formula(theirs, names)


def reach(kind: str, parameters: list[float]) -> list[float]:
    """Return the x values of a shape's ends as in jFuzzyLogic (`estimateUniverse`); empty for shapes that it lacks.

    A gaussian ends 4 sigma from its mean, a bell at a membership of 0.001, and a sigmoid 9 / slope from its inflection.
    For a piecewise shape, all parameters are returned.
    """
    match kind, parameters:
        case "gaussian", [mean, sigma, *_]:
            return [mean - 4 * sigma, mean + 4 * sigma]
        case "gaussian-product", [left, rise, right, fall, *_]:
            return [left - 4 * rise, right + 4 * fall]
        case "bell", [center, width, slope, *_] if slope >= 0.01:
            ends: float = width * 999 ** (1 / (2 * slope))
            return [center - ends, center + ends]
        case "sigmoid", [inflection, slope, *_] if slope:
            return [inflection - 9 / abs(slope), inflection + 9 / abs(slope)]
        case "sigmoid-difference", [left, rise, fall, right, *_] if rise and fall:
            return [x + sign * 9 / abs(slope) for x, slope in ((left, rise), (right, fall)) for sign in (-1, 1)]
        case "cosine", [center, width, *_]:
            return [center - width / 2, center + width / 2]
        case (("triangle" | "trapezoid" | "rectangle" | "ramp" | "s-shape" | "z-shape" | "pi-shape"), _):
            return parameters[: len(TERM_PARAMETERS[kind])]
    return []
