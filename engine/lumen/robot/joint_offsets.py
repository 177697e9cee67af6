"""Moves joints to the offsets of life and gestures beneath all commands: without jerks, and not too fast."""

from collections.abc import Mapping

_REACHED = 1e-4


def approach(
    offsets: dict[str, float], goals: Mapping[str, float], speeds: Mapping[str, float], dt: float, settling: float
) -> None:
    """Move `offsets` in place towards `goals` [rad; hands 0..1] for `dt` [s]; a joint without a goal returns to 0.

    `settling` [s] is the time constant of the approach, and `speeds` [rad/s; hands 1/s] has the greatest speed of each
    joint. Joints that are back at 0 are removed from `offsets`.
    """
    share = min(1.0, dt / settling)
    for joint in (*offsets, *(goals.keys() - offsets.keys())):
        offset, goal = offsets.get(joint, 0.0), goals.get(joint, 0.0)
        most, way = speeds[joint] * dt, (goal - offset) * share
        offset += way if -most < way < most else most if way > 0.0 else -most
        if goal == 0.0 and abs(offset) < _REACHED:
            offsets.pop(joint, None)
        else:
            offsets[joint] = offset
