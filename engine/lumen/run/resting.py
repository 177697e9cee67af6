"""What lets a robot rest at once: on a way of its own to the robot, and to the behaviour where the robot is gone."""

from contextlib import suppress
from typing import Any

from lumen.errors import BusError
from lumen.ports import Bus
from lumen.run.reload.requests import COMMAND, command_key

STOP_TIMEOUT = 10.0
"""How long the robot may take to rest, foot in the air and all [s]."""
TAKEN = "command finished"
"""What a robot answers that has done what it was told."""


def rest_body(by: str) -> dict[str, Any]:
    """The command, in the name of somebody, for the robot's key `stop`; the robot tells the behaviour."""
    return {"type": "motion", "method": "rest", "parameter": {"by": by}}


def resume_body(by: str) -> dict[str, Any]:
    """What lets a robot that was stopped move again; on the same key."""
    return {"type": "motion", "method": "resume", "parameter": {"by": by}}


def stop_behavior(bus: Bus, robot: str) -> None:
    """Have the behaviour stop, where nobody of the robot answers; a bus that is away loses it."""
    for key in (command_key(robot), COMMAND):
        with suppress(BusError):
            bus.publish(key, {"command": "stop"})


def no_robot(key: str) -> str:
    """What a person is told then."""
    return f"the robot does not answer on `{key}` and may still move: press the button on its chest"
