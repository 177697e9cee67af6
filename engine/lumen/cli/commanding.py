"""A command to the robot of a running exhibition, as any module would send it."""

import argparse
import sys
from typing import Any

from lumen.app.asking import ask
from lumen.cli.reach import reach

ANSWERS = "lumen.operator.answer"
COMMAND_TIMEOUT = 30.0


def command(options: argparse.Namespace, body: Any, done: str, first: tuple[str, Any] | None = None) -> int:
    """Send it and wait for the answer: prints `done` and gives 0, or says why not and gives 1.

    `first` is a message (key, body) that goes before it.
    """
    reached = reach(options)
    try:
        if first:
            reached.bus.publish(*first)
        answer = str(next(ask(reached.bus, reached.command, body, ANSWERS, first=COMMAND_TIMEOUT)))
    finally:
        reached.bus.close()
    if answer == "command finished":
        print(done)
        return 0
    print(f"lumen {options.verb}: {answer}", file=sys.stderr)
    return 1
