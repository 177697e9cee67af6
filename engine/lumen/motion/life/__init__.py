"""Idle life of a robot: pure functions of a style, a seed and the time."""

from lumen.motion.life.movements import (
    PEAK_SLOPE,
    SETTLE_SLOPE,
    SPEED_SHARE,
    Attention,
    aside,
    eyes_closed,
    gestures_wanted,
    glance,
    look_towards,
    nod,
    settle,
    style_name,
    sway,
    vigour,
)

__all__ = [
    "PEAK_SLOPE", "SETTLE_SLOPE", "SPEED_SHARE", "Attention", "aside",
    "eyes_closed", "gestures_wanted", "glance", "look_towards", "nod", "settle", "style_name", "sway", "vigour",
]  # fmt: skip
