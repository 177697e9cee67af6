"""Joints on their way to an `Aim`: NAOqi's `setAngles`, which nobody waits for."""

from collections.abc import Callable

from lumen.features.simulation.motors import Motors
from lumen.ports import Aim


class AimController:
    """Moves the goals of joints that no command owns; a later aim replaces an earlier one, joint by joint."""

    def __init__(self, motors: Motors) -> None:
        self._motors = motors
        self._aims: dict[str, tuple[float, float]] = {}

    def aim(self, aim: Aim) -> None:
        """Begin."""
        speeds = self._motors.envelope.speed
        for name, angle in aim.angles.items():
            speed = float(speeds[self._motors.index[name]]) * aim.speed
            self._aims[name] = angle, speed

    def advance(self, dt: float, free: Callable[[str], bool]) -> None:
        """Live `dt` [s]; an aim ends where it is reached, or where its joint is not free any more."""
        moved = {}
        for name, (angle, speed) in list(self._aims.items()):
            if not free(name):
                del self._aims[name]
                continue
            goal = float(self._motors.goal[self._motors.index[name]])
            moved[name] = min(max(angle, goal - speed * dt), goal + speed * dt)
            if moved[name] == angle:
                del self._aims[name]
        if moved:
            self._motors.aim(moved)
