"""Idle life of a robot: pure functions of a style, a seed and the time."""

from lumen.motion.life.blinking import eyes_closed
from lumen.motion.life.looking import Attention, aside, glance, look_towards, nod
from lumen.motion.life.mood import gestures_wanted, style_name
from lumen.motion.life.settling import SETTLE_SLOPE, settle
from lumen.motion.life.swaying import PEAK_SLOPE, SPEED_SHARE, sway
from lumen.motion.life.vigours import vigour

__all__ = [
    "PEAK_SLOPE", "SETTLE_SLOPE", "SPEED_SHARE", "Attention", "aside",
    "eyes_closed", "gestures_wanted", "glance", "look_towards", "nod", "settle", "style_name", "sway", "vigour",
]  # fmt: skip
