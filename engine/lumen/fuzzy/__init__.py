"""Fuzzy inference: Mamdani, Takagi-Sugeno and Tsukamoto, and any mixture of them.

Each name is imported on first use. `__init__.pyi` declares the same names for type checkers.
"""

from lumen.upkeep.lazy_names import lazy

__all__ = ["Controller", "Evaluator", "Explanation"]

_HOMES = {
    "lumen.standalone.controller": ("Controller",),
    "lumen.fuzzy.evaluator": ("Evaluator",),
    "lumen.fuzzy.explanation": ("Explanation",),
}

__getattr__ = lazy(__name__, _HOMES)
