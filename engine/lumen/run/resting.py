"""Commands that make a robot rest at once: to the robot directly, and to the behaviour if the robot is gone."""

from contextlib import suppress
from typing import Any

from lumen.errors import BusError
from lumen.ports import Bus
from lumen.run.reload.requests import COMMAND, command_key

STOP_TIMEOUT = 10.0
"""The longest time that the robot may need to rest, even with a foot in the air [s]."""
TAKEN = "command finished"
"""A robot's answer after it has executed a command."""


def rest_body(by: str) -> dict[str, Any]:
    """Return the command to rest on behalf of `by`, to be sent on the robot's key `stop`.

    The robot notifies the behaviour.
    """
    return {"type": "motion", "method": "rest", "parameter": {"by": by}}


def resume_body(by: str) -> dict[str, Any]:
    """Return the command that lets a stopped robot move again, to be sent on the robot's key `stop`."""
    return {"type": "motion", "method": "resume", "parameter": {"by": by}}


def stop_behavior(bus: Bus, robot: str) -> None:
    """Stop the behaviour of a robot that does not answer; if the bus is gone, nothing happens."""
    for key in (command_key(robot), COMMAND):
        with suppress(BusError):
            bus.publish(key, {"command": "stop"})


def no_robot(key: str) -> str:
    """Return the line for a person if no robot answers."""
    return f"the robot does not answer on `{key}` and may still move: switch it off (NAO: hold the button on its chest)"
