"""What forbids a step: something near ahead, or a hand on a button."""

from collections.abc import Mapping

from lumen.robots.simulation.sonar import Sonars

OBSTACLE_DISTANCE = 0.4
"""Nearer than this to something the robot does not walk [m]."""

STOP_BUTTONS = {
    "RightBumper": "the right bumper",
    "LeftBumper": "the left bumper",
    "ChestButton": "the chest button",
}


class Hazards:
    """Looks at the sonars, where there are any, and at which tactile sensors are `pressed`, now."""

    def __init__(self, sonars: Sonars | None, pressed: Mapping[str, bool]) -> None:
        self._sonars, self._pressed = sonars, pressed

    def danger(self) -> str:
        """Why the robot must not walk now; empty where nothing is in the way."""
        for sensor, name in STOP_BUTTONS.items():
            if self._pressed.get(sensor):
                return f"{name} is pressed"
        distance = min(self._sonars.measure()) if self._sonars else OBSTACLE_DISTANCE
        return (
            f"something is {distance:.2f} m ahead, nearer than {OBSTACLE_DISTANCE:g} m"
            if distance < OBSTACLE_DISTANCE
            else ""
        )
