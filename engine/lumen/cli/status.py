"""`lumen status`: print the state of a running exhibition."""

import argparse
import json
from collections.abc import Iterator, Sequence
from datetime import UTC, datetime
from typing import Any

from lumen.cli.printing import clock_time
from lumen.cli.projects import shown_project
from lumen.cli.reach import configure_reach
from lumen.errors import BusError
from lumen.language.events import HELD
from lumen.language.operator_requests import STATUS
from lumen.run.asking import FIRST_ANSWER_TIMEOUT, OPERATOR_ANSWERS, operator_key, send_request
from lumen.run.one_robot import one_robot, robots_of
from lumen.run.reaching import reach_exhibition
from lumen.run.recovery.last_run import last_run

AMONG_OTHERS = 5.0
"""The time limit for the answer of one of several robots [s]."""
EARS = {
    "always": "listen",
    "face": "listen: a face is near and looks at the robot",
    "touch": "listen: a hand touched the robot",
    "speaks": "hear only interruptions: the robot speaks",
    "nobody": "hear only interruptions: no visitor looks at the robot from nearby or touches it",
}
"""Descriptions of the ears' state, by the reason in a message on the route `listening`."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the options of `lumen status` to its parser."""
    configure_reach(parser)
    parser.add_argument("--format", choices=("text", "json"), default="text", help="output format (default: text)")


def run(options: argparse.Namespace) -> int:
    """Print the status of each robot; return 0.

    For a robot that does not answer, print the record of its last run. Raises BusError if no robot answers.
    """
    root = shown_project(options.project)
    names = [options.robot_name] if options.robot_name else list(robots_of(root, None)) or [""]
    answers = [_status(options, name, AMONG_OTHERS if names[1:] else FIRST_ANSWER_TIMEOUT) for name in names]
    found = [
        last_run(root, one_robot(root, name)) if isinstance(one, BusError) else one
        for name, one in zip(names, answers, strict=True)
    ]
    none = answers[0] if all(isinstance(one, BusError) for one in answers) else None
    if options.format == "json" and not isinstance(none, BusError):
        print(json.dumps(found[0] if len(names) == 1 else {"robots": found}, ensure_ascii=False))
    elif options.format == "text":
        _print([status for status in found if none is None or status["ended"] or status["stopped"]])
    if isinstance(none, BusError):
        raise none
    return 0


def _status(options: argparse.Namespace, name: str, patience: float) -> dict[str, Any] | BusError:
    """Return the status that a robot reports, or the error if it does not answer within `patience` [s]."""
    try:
        reached = reach_exhibition(options.project, options.bus, name)
    except BusError as error:
        return error
    try:
        found: dict[str, Any] = next(
            send_request(reached.bus, operator_key(reached.robot), STATUS(), OPERATOR_ANSWERS, first=patience)
        )
        return found
    except BusError as error:
        return error
    finally:
        reached.bus.close()


def _print(found: Sequence[dict[str, Any]]) -> None:
    for i, status in enumerate(found):
        if i:
            print()
        for name, text in (_lines if "configuration" in status else _absent)(status, datetime.now(UTC)):
            text = "".join(sign if sign.isprintable() else "\N{REPLACEMENT CHARACTER}" for sign in text)
            print(f"{name:<9} {text}")


def _absent(status: dict[str, Any], now: datetime) -> Iterator[tuple[str, str]]:
    """Yield the lines about a robot that does not answer, each as a name and a text."""
    name = status["robot"] or "robot"
    if status["held"]:
        yield name, "does not answer, although its process on this machine is alive"
    elif status["ended"]:
        how = "was ended" if status["told"] else "ended unexpectedly"
        yield name, f"is not running: it {how} at {_ago(status['ended'], now)}"
    else:
        yield name, "is not running"
    if status["stopped"]:
        yield "stopped", f"by {status['stopped_by']}; it stays stopped after a restart. To let it move, {HELD}"


def _lines(status: dict[str, Any], now: datetime) -> Iterator[tuple[str, str]]:
    """Yield the lines about a running robot, each as a name and a text; normal conditions are omitted."""
    yield str(status["robot"]), f"in {', '.join(status['configuration'])}"
    yield "since", _ago(status["since"], now)
    yield "visitor", f"{status['visitor'] or 'no name known'}, spoken to in {status['language']}"
    if status["battery"] is not None:
        yield "battery", f"{status['battery']} %"
    if ears := status["ears"]:
        yield "ears", EARS.get(ears["because"], f"{'listen' if ears['listening'] else 'deaf'}: {ears['because']}")
    for module in status.get("modules", ()):
        reason = f": {module['reason']}" if module["reason"] else ""
        yield "module", f"{module['module']} is {module['state']} since {_ago(module['since'], now)}{reason}"
    for timer in status["timers"]:
        yield "timer", f"{timer['event']}: due {_ahead(timer['due'], now)}"
    if status["stopped"]:
        yield "stopped", f"by {status['stopped_by']}: to let it move again, {HELD}"
    if status["realtime"] < 1.0:
        yield "time", f"the exhibition is running at {status['realtime']:.2f} × real time"
    if reload := status["last_reload"]:
        yield "reload", f"{reload['verdict']} {_ago(reload['at'], now)}: {reload['text']}"
    yield "files", str(status["bundle"])[:16]


def _ago(text: str, now: datetime) -> str:
    at = datetime.fromisoformat(text)
    return f"{at.astimezone():%H:%M:%S}, {clock_time(max(0.0, (now - at).total_seconds()))} ago"


def _ahead(text: str, now: datetime) -> str:
    at = datetime.fromisoformat(text)
    return f"{at.astimezone():%H:%M:%S}, in {clock_time(max(0.0, (at - now).total_seconds()))}"
