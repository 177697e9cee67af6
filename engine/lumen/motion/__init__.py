"""Motions: trajectories, limits, gestures, gaits, idle life, and joints that follow what the camera sees.

Each name is imported on first use. `__init__.pyi` declares the same names for type checkers.
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
