"""Hazards that forbid a step: an obstacle ahead, or a hand on a button."""

from collections.abc import Mapping

from lumen.features.simulation.hall_sensors import Sonars
from lumen.robot.hazards import danger


class Hazards:
    """Checks the sonars, if there are any, and the tactile sensors in `pressed`, which is updated elsewhere."""

    def __init__(self, sonars: Sonars | None, pressed: Mapping[str, bool]) -> None:
        self._sonars, self._pressed = sonars, pressed

    def danger(self) -> str:
        """Return the reason why the robot must not walk now; empty if nothing is in the way."""
        return danger(self._pressed, self._sonars.measure() if self._sonars else ())
