"""The joint angles at a moment of a gesture."""

from collections.abc import Iterator
from itertools import pairwise

from lumen.language.gestures import Gesture

BEAT = "beat"
"""The tag of gestures that suit any phrase."""

GESTURE_SHARE = 0.5
"""The part of its maximum speed that a joint uses for a gesture."""

_PEAK = 1.875
"""The peak speed of a minimum-jerk movement, relative to the mean speed."""


def gesture_offsets(gesture: Gesture, since: float, *, other_side: bool = False) -> dict[str, float]:
    """Return the joints' offsets [rad] `since` [s] after the gesture began; empty before and after it.

    With `other_side` they are mirrored.
    """
    if not 0.0 < since < gesture.duration:
        return {}
    found = {}
    for joint, keys in gesture.tracks.items():
        for (t0, a0), (t1, a1) in pairwise(keys):
            if since <= t1:
                u = (since - t0) / (t1 - t0)
                found[joint] = a0 + (a1 - a0) * u * u * u * (10 + u * (6 * u - 15))
                break
    return dict(_mirror(gesture, found)) if other_side else found


def peak_speeds(gesture: Gesture) -> dict[str, float]:
    """Return the peak speed of each joint [rad/s]."""
    return {
        joint: max(_PEAK * abs(a1 - a0) / (t1 - t0) for (t0, a0), (t1, a1) in pairwise(keys))
        for joint, keys in gesture.tracks.items()
    }


def _mirror(gesture: Gesture, offsets: dict[str, float]) -> Iterator[tuple[str, float]]:
    for joint, angle in offsets.items():
        other, sign = gesture.mirror.get(joint, (joint, 1.0))
        if other:
            yield other, sign * angle
