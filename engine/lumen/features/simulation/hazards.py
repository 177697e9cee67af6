"""What forbids a step: something near ahead, or a hand on a button."""

from collections.abc import Mapping

from lumen.features.simulation.sonar import Sonars
from lumen.robot.hazards import danger


class Hazards:
    """Looks at the sonars, where there are any, and at which tactile sensors are `pressed`, now."""

    def __init__(self, sonars: Sonars | None, pressed: Mapping[str, bool]) -> None:
        self._sonars, self._pressed = sonars, pressed

    def danger(self) -> str:
        """Why the robot must not walk now; empty where nothing is in the way."""
        return danger(self._pressed, self._sonars.measure() if self._sonars else ())
