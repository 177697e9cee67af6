"""FuzzyLite's names for shapes, norms and methods, and number formats."""

from collections.abc import Mapping
from math import inf

from lumen.language.controllers import ACTIVATIONS, DEFUZZIFIERS, S_NORMS, T_NORMS, TERM_PARAMETERS
from lumen.project.numbers import LEAST_NUMBER


def _camel(word: str) -> str:
    return "".join(part.capitalize() for part in word.split("-"))


SHAPES: Mapping[str, str] = {_camel(kind): kind for kind in TERM_PARAMETERS}
NORMS: Mapping[str, str] = {_camel(norm): norm for norm in (*T_NORMS, *S_NORMS)}
METHODS: Mapping[str, str] = {_camel(method): method for method in DEFUZZIFIERS}
ACTIVATED: Mapping[str, str] = {_camel(method): method for method in ACTIVATIONS}
"""Lumen's names, by FuzzyLite's."""


def foreign(words: Mapping[str, str], ours: str) -> str:
    """Return FuzzyLite's name for one of Lumen's."""
    return next(name for name, word in words.items() if word == ours)


def written(value: float) -> str:
    """Format a number for FuzzyLite, with all digits."""
    if value in (inf, -inf):
        return "inf" if value > 0 else "-inf"
    return str(int(value)) if value == int(value) and abs(value) < 1e15 else repr(float(value))


def plain(value: float) -> int | float:
    """Return a number for YAML: an integer if it is whole and below 1e15, 0 if it is a rounding error."""
    if abs(value) < LEAST_NUMBER:
        return 0
    return int(value) if abs(value) < 1e15 and value == int(value) else value
