"""`lumen resume`: let a robot that a person stopped move again."""

import argparse
from typing import Any

from lumen.cli.agreeing import agrees
from lumen.cli.commanding import answered, told
from lumen.cli.formats import configure_format
from lumen.cli.person import person
from lumen.cli.reach import configure_reach, for_each_robot, reach
from lumen.errors import UsageError
from lumen.language.iso_time import local_time, time_of
from lumen.run.resting import resume_body

RESUME_TIMEOUT = 10.0


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the options of `lumen resume` to its parser."""
    parser.add_argument("-y", "--yes", action="store_true", help="do not ask whether there is room around the robot")
    configure_reach(parser)
    configure_format(parser)


def run(options: argparse.Namespace) -> int:
    """Ask for confirmation and send the request to each robot; return 0, or 1 if one was refused or not confirmed.

    Raises UsageError if confirmation is needed, but can't be asked for.
    """
    if options.format == "json" and not options.yes:
        raise UsageError("--format json can't ask for confirmation: add --yes")
    return for_each_robot(options, _resume)


def _resume(options: argparse.Namespace) -> int:
    reached = reach(options)
    try:
        ask = {"type": "motion", "method": "stopped"}
        stopped = answered(reached.bus, reached.stop, ask, RESUME_TIMEOUT)
        if not options.yes and not _sure(stopped, options.robot_name or "the robot"):
            print("nothing has changed")
            return 1
        answer = answered(reached.bus, reached.stop, resume_body(person()), RESUME_TIMEOUT)
    finally:
        reached.bus.close()
    return told(options, answer, f"{options.robot_name or 'the robot'} may move again")


def _here(since: object) -> str:
    """Return a time in the local time zone; return any other text unchanged."""
    try:
        return local_time(time_of(str(since)))
    except ValueError:
        return str(since)


def _sure(stopped: Any, robot: str) -> bool:
    """Print who stopped the robot and why confirmation is needed; return True if the person confirms."""
    by, since = (stopped.get(key) for key in ("stopped_by", "since")) if isinstance(stopped, dict) else ("", "")
    print(f"{by} stopped {robot} at {_here(since)}." if by else f"{robot[0].upper()}{robot[1:]} is not stopped.")
    otherwise = "resume asks for confirmation, but this is not a terminal: add --yes if there is room around the robot"
    print("It may stand up at once, and Lumen can't see who is near. `--yes` skips this question.")
    return agrees("Is there room around it?", otherwise)
