"""Read a project from its folder: values built from text, each with its file and line.

Each name is imported when it is first used. `__init__.pyi` has the same names for type checkers.
"""

from lumen.upkeep.lazy_names import lazy

__all__ = ["Project", "load"]

_HOMES = {
    "lumen.standalone.project": ("load",),
    "lumen.language.projects": ("Project",),
}

__getattr__ = lazy(__name__, _HOMES)
