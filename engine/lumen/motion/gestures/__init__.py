"""The choice and the timing of gestures that accompany a text, and their joint angles: pure functions."""

from lumen.motion.gestures.planning import PlannedGesture, plan_gestures
from lumen.motion.gestures.posing import BEAT, GESTURE_SHARE, gesture_offsets, peak_speeds

__all__ = ["BEAT", "GESTURE_SHARE", "PlannedGesture", "gesture_offsets", "peak_speeds", "plan_gestures"]
