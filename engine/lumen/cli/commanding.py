"""A command to the robot of a running exhibition, as any module would send it."""

import argparse
import sys
from typing import Any

from lumen.app.asking import ask
from lumen.cli.reach import reach
from lumen.ports import Bus

ANSWERS = "lumen.operator.answer"
COMMAND_TIMEOUT = 30.0


def command(options: argparse.Namespace, body: Any, done: str) -> int:
    """Send it and wait for the answer: prints `done` and gives 0, or says why not and gives 1."""
    reached = reach(options)
    try:
        answer = answered(reached.bus, reached.command, body, COMMAND_TIMEOUT)
    finally:
        reached.bus.close()
    return told(options.verb, answer, done)


def answered(bus: Bus, key: str, body: Any, timeout: float) -> Any:
    """What the robot says to it. Raises BusError where it says nothing within the timeout [s]."""
    return next(ask(bus, key, body, ANSWERS, first=timeout))


def told(verb: str, answer: Any, done: str) -> int:
    """Print that it is `done`, or the answer that says why not; the exit code."""
    if answer == "command finished":
        print(done)
        return 0
    print(f"lumen {verb}: {answer}", file=sys.stderr)
    return 1
