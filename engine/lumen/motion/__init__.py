"""Motions: trajectories, limits, gestures, gaits, life, and what follows what is seen.

Each name is imported when it is first used. `__init__.pyi` has the same names for type checkers.
"""

from lumen.upkeep.lazy_names import lazy

__all__ = ["Excess", "Motion", "Trajectory", "beyond_limits", "overspeed"]

_HOMES = {
    "lumen.standalone.motion": ("Motion",),
    "lumen.motion.limits": (
        "Excess",
        "beyond_limits",
        "overspeed",
    ),
    "lumen.motion.trajectories": ("Trajectory",),
}

__getattr__ = lazy(__name__, _HOMES)
