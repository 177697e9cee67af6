"""Hazards that forbid a step: an obstacle ahead, or a pressed bumper or chest button."""

from collections.abc import Mapping

from lumen.features.simulation.hall_sensors import Sonars
from lumen.robot.hazards import danger


class Hazards:
    """Checks any sonars, and the tactile sensors in `pressed`, which the robot keeps up to date."""

    def __init__(self, sonars: Sonars | None, pressed: Mapping[str, bool]) -> None:
        self._sonars, self._pressed = sonars, pressed

    def danger(self) -> str:
        """Return the reason why the robot must not walk now; empty without a hazard."""
        return danger(self._pressed, self._sonars.measure() if self._sonars else ())
