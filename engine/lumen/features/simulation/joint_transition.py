"""A smooth movement of joints from one posture to another."""

from collections.abc import Callable, Mapping

from lumen.features.simulation.motors import Motors
from lumen.robot.joint_ways import way_duration

MIN_TRANSITION_TIME, MAX_TRANSITION_TIME = 0.6, 2.0
"""The durations of a posture change at speed 1 and at low speeds [s]; with them, the robot never fell in trials."""

_HALT = 0.4


def duration(speed: float) -> float:
    """Return the duration of a posture change [s]; `speed` is a share of the maximum (above 0, up to 1)."""
    return min(MAX_TRANSITION_TIME, MIN_TRANSITION_TIME / speed)


class JointTransition:
    """Moves all joints of `targets` [rad] together along a smoothstep.

    The movement lasts `seconds` [s], or longer if a joint needs more time. `after` is called at the end unless the
    transition was cancelled. A cancelled transition halts within 0.4 s.
    """

    def __init__(
        self,
        motors: Motors,
        targets: Mapping[str, float],
        now: float,
        seconds: float,
        after: Callable[[], None] | None = None,
    ) -> None:
        self._motors, self._begin, self._after = motors, now, after
        self._start = motors.wanted(targets)
        self._way = {name: targets[name] - angle for name, angle in self._start.items()}
        self._seconds = way_duration(self._way, motors.body, seconds)
        self._now = now
        self._halt: tuple[float, float, float] | None = None

    def advance(self, now: float) -> bool:
        """Move the joints' goals for `now` [s]; return True at the end."""
        self._now = now
        if self._halt:
            return self._come_to_rest(now, *self._halt)
        u = min(1.0, (now - self._begin) / self._seconds)
        self._go(u * u * (3 - 2 * u))
        if u >= 1.0 and self._after:
            self._after()
        return u >= 1.0

    def cancel(self) -> None:
        """Begin to slow down; `advance` returns True when the goals are at rest."""
        u = min(1.0, (self._now - self._begin) / self._seconds)
        self._halt = self._now, u * u * (3 - 2 * u), 6 * u * (1 - u) / self._seconds

    def _come_to_rest(self, now: float, since: float, done: float, rate: float) -> bool:
        """Slow down evenly from `rate` [1/s], starting at the share `done` of the movement; return True at rest."""
        t = min(now - since, _HALT)
        self._go(min(1.0, done + rate * t * (1 - t / (2 * _HALT))))
        return t >= _HALT

    def _go(self, part: float) -> None:
        self._motors.aim({name: angle + part * self._way[name] for name, angle in self._start.items()})
