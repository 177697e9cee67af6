"""`lumen goto STATE`: make a running exhibition enter a state, as if a transition led there."""

import argparse
import sys
from typing import Any

from lumen.cli.agreeing import agrees
from lumen.cli.formats import configure_format, print_object
from lumen.cli.person import person
from lumen.cli.reach import configure_reach, reach
from lumen.errors import UsageError
from lumen.language.events import HELD
from lumen.language.operator_requests import GOTO
from lumen.run.asking import OPERATOR_ANSWERS, operator_key, send_request
from lumen.run.reaching import Reached


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the options of `lumen goto` to its parser."""
    parser.add_argument("state", metavar="STATE", help="a state's id, or its path such as guide.talking")
    parser.add_argument("-y", "--yes", action="store_true", help="do not ask for confirmation")
    configure_reach(parser)
    configure_format(parser)


def run(options: argparse.Namespace) -> int:
    """Ask for confirmation and send the request; return 0, or 1 if it was refused or not confirmed.

    Raises UsageError if confirmation is needed, but can't be asked for.
    """
    if options.format == "json" and not options.yes:
        raise UsageError("--format json can't ask for confirmation: add --yes")
    reached = reach(options)
    try:
        way = _request(reached, options.state, only="check")
        if way["verdict"] != "refused":
            if not options.yes and not _sure(options.state, way):
                print("nothing is changed")
                return 1
            way = _request(reached, options.state, by=person())
    finally:
        reached.bus.close()
    if options.format == "json":
        print_object(way)
        return int(way["verdict"] == "refused")
    if way["verdict"] == "refused":
        print(f"lumen goto: {way['reason']}", file=sys.stderr)
        return 1
    print(f"in {', '.join(way['entered'])}")
    if by := way.get("stopped_by"):
        print(f"{by} stopped the robot: to let it move again, {HELD}")
    return 0


def _request(reached: Reached, state: str, **more: str) -> dict[str, Any]:
    question = GOTO(state=state, **more)
    answer: dict[str, Any] = next(send_request(reached.bus, operator_key(reached.robot), question, OPERATOR_ANSWERS))
    return answer


def _sure(state: str, way: dict[str, Any]) -> bool:
    """Print the states that are left and entered; return True if the person at the terminal confirms."""
    left = f"leaves {', '.join(way['exited'])} and " if way["exited"] else ""
    print(f"This {left}enters {', '.join(way['entered'])}; guards are not checked.")
    return agrees(f"Go to {state}?", "goto asks for confirmation, but this is not a terminal: add --yes")
