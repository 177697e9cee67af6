"""What `lumen why` and `lumen why-not` have in common: whom they ask, and what they do with the answer."""

import argparse
import sys
from collections.abc import Callable, Iterator
from datetime import datetime
from typing import Any

from lumen.cli.formats import configure_format, print_object
from lumen.cli.moments import moment
from lumen.cli.reach import configure_reach, reach
from lumen.errors import BusUnreachableError, UsageError
from lumen.language.operator_requests import OperatorRequest
from lumen.run.asking import OPERATOR_ANSWERS, ask, operator_key
from lumen.run.recalling import answer_from_journal


def configure_question(parser: argparse.ArgumentParser) -> None:
    configure_reach(parser)
    parser.add_argument("--at", metavar="T", help="the time to ask about, such as 14:03 or 14:03:20 (default: now)")
    configure_format(parser)


def put(
    options: argparse.Namespace, question: OperatorRequest, shown: Callable[[dict[str, Any]], Iterator[str]]
) -> int:
    """Ask a running exhibition, else the journal of the project, and print what it says; 1 where that is no answer."""
    at = moment(options.at, datetime.now().astimezone()) if options.at else None
    try:
        found = _asked(options, question, at)
    except UsageError as error:
        found = {"verdict": "refused", "reason": str(error)}
    if "reason" in found:
        print(f"lumen {question.ask}: {found['reason']}", file=sys.stderr)
        return 1
    if options.format == "json":
        print_object(found)
        return 0
    for line in shown(found):
        print("".join(sign if sign.isprintable() else "\N{REPLACEMENT CHARACTER}" for sign in line))
    return 0


def _asked(options: argparse.Namespace, question: OperatorRequest, at: str | None) -> dict[str, Any]:
    what = options.what or ""
    try:
        reached = reach(options)
    except BusUnreachableError as error:
        return answer_from_journal(options.project, question.ask, what, at, str(error), options.robot_name)
    try:
        body = question(what=what, **({"at": at} if at else {}))
        found: dict[str, Any] = next(ask(reached.bus, operator_key(reached.robot), body, OPERATOR_ANSWERS))
    finally:
        reached.bus.close()
    if found.get("kept") == "later":
        return answer_from_journal(options.project, question.ask, what, at, found["reason"], options.robot_name)
    return found
