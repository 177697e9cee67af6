"""Moves joints to the offsets of life and gestures beneath all commands: without jerks, and not too fast."""

from collections.abc import Mapping

_REACHED = 1e-4


def approach(
    offsets: dict[str, float], goals: Mapping[str, float], speeds: Mapping[str, float], dt: float, settling: float
) -> None:
    """Bring `offsets` nearer to `goals` [rad; hands 0..1] in `dt` [s]; a joint that is wanted nowhere goes back to 0.

    `settling` [s] is the time constant of the way, `speeds` [rad/s] is the most for each joint. Those that are back are
    taken out.
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
