"""`lumen stop`: the robot of a running exhibition rests, at once, and moves for nobody until a person lets it."""

import argparse

from lumen.app.reload.requests import COMMAND, command_key
from lumen.cli.commanding import answered, told
from lumen.cli.formats import configure_format
from lumen.cli.person import person
from lumen.cli.reach import configure_reach, reach
from lumen.errors import BusError, BusUnreachableError

STOP_TIMEOUT = 10.0
"""How long the robot may take to rest, foot in the air and all [s]."""


def configure(parser: argparse.ArgumentParser) -> None:
    configure_reach(parser)
    configure_format(parser)


def run(options: argparse.Namespace) -> int:
    """0 once it rests, 1 where it could not. It has a way of its own, and the robot tells the behaviour."""
    reached = reach(options)
    rest = {"type": "motion", "method": "rest", "parameter": {"by": person()}}
    try:
        answer = answered(reached.bus, reached.stop, rest, STOP_TIMEOUT)
    except BusError:
        for key in (command_key(reached.robot), COMMAND):  # the behaviour, where only the robot is gone
            reached.bus.publish(key, {"command": "stop"})
        raise BusUnreachableError(
            f"no robot answers on `{reached.stop}`: it may still move. Press the button on its chest"
        ) from None
    finally:
        reached.bus.close()
    return told(options, answer, "the robot rests; hold its head, or `lumen resume`, to let it go on")
