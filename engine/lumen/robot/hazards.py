"""The reasons why any robot must not walk: an obstacle near ahead, or a hand on a button."""

from collections.abc import Iterable, Mapping

OBSTACLE_DISTANCE = 0.4
"""A robot does not walk if an obstacle is nearer than this [m]."""

STOP_BUTTONS = {
    "RightBumper": "the right bumper",
    "LeftBumper": "the left bumper",
    "BackBumper": "the back bumper",
    "ChestButton": "the chest button",
}


def danger(pressed: Mapping[str, bool], distances: Iterable[float]) -> str:
    """Return why a robot must not walk now; empty if it may.

    `pressed` has the tactile sensors, `distances` what the sonars measure [m].
    """
    for sensor, name in STOP_BUTTONS.items():
        if pressed.get(sensor):
            return f"{name} is pressed"
    near = min(distances, default=OBSTACLE_DISTANCE)
    return f"something is {near:.2f} m ahead, nearer than {OBSTACLE_DISTANCE:g} m" if near < OBSTACLE_DISTANCE else ""
