"""A command to the robot of a running exhibition, as any module would send it."""

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
    """Send it and wait for the answer: prints `done` and gives 0, or says why not and gives 1."""
    reached = reach(options)
    try:
        answer = answered(reached.bus, reached.command, body, COMMAND_TIMEOUT)
    finally:
        reached.bus.close()
    return told(options, answer, done)


def answered(bus: Bus, key: str, body: Any, timeout: float) -> Any:
    """What the robot says to it. Raises BusError where it says nothing within the timeout [s]."""
    return next(send_request(bus, key, body, OPERATOR_ANSWERS, first=timeout))


def told(options: argparse.Namespace, answer: Any, done: str) -> int:
    """Print that it is `done`, or the answer that says why not; the exit code."""
    well = answer == TAKEN
    if options.format == "json":
        print_object({"ok": well, "answer": done if well else answer})
    elif well:
        print(done)
    else:
        print(f"lumen {options.verb}: {answer}", file=sys.stderr)
    return int(not well)
