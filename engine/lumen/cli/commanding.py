"""Send a command to the robot of a running exhibition, on the route that modules use too."""

import argparse
import sys
from typing import Any

from lumen.cli.formats import print_object
from lumen.cli.reach import reach
from lumen.ports import Bus
from lumen.run.asking import OPERATOR_ANSWERS, send_request
from lumen.run.resting import TAKEN

COMMAND_TIMEOUT = 30.0


def command(options: argparse.Namespace, body: Any, done: str) -> int:
    """Send a command and wait for the answer; print `done` and return 0, or print the refusal and return 1.

    Raises BusError if no exhibition is running, or no answer arrives within COMMAND_TIMEOUT [s].
    """
    reached = reach(options)
    try:
        answer = answered(reached.bus, reached.command, body, COMMAND_TIMEOUT)
    finally:
        reached.bus.close()
    return told(options, answer, done)


def answered(bus: Bus, key: str, body: Any, timeout: float) -> Any:
    """Send a request and return the robot's answer. Raises BusError if none arrives within the timeout [s]."""
    return next(send_request(bus, key, body, OPERATOR_ANSWERS, first=timeout))


def told(options: argparse.Namespace, answer: Any, done: str) -> int:
    """Print `done` if the robot accepted the command, else its answer; return the exit code, 0 or 1."""
    well = answer == TAKEN
    if options.format == "json":
        print_object({"ok": well, "answer": done if well else answer})
    elif well:
        print(done)
    else:
        print(f"lumen {options.verb}: {answer}", file=sys.stderr)
    return int(not well)
