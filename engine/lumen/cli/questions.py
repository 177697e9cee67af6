"""The common part of `lumen why` and `lumen why-not`: ask the exhibition, else the journal, and print the answer."""

import argparse
import sys
from collections.abc import Callable, Iterator
from datetime import UTC, datetime, timedelta
from typing import Any

from lumen.cli.formats import configure_format, print_object
from lumen.cli.reach import configure_reach, reach
from lumen.errors import BusUnreachableError, UsageError
from lumen.language.iso_time import time_of_day
from lumen.language.operator_requests import OperatorRequest
from lumen.run.asking import OPERATOR_ANSWERS, operator_key, send_request
from lumen.run.recalling import answer_from_journal


def moment(text: str, now: datetime) -> str:
    """Return the moment of a time that was typed, as ISO 8601 in UTC.

    A time of day is in the 24 hours before `now`, the local time: `14:03` is the end of that minute, and `14:03:20` the
    end of that second. A time with a date is exactly that moment. Raises UsageError for any other text.
    """
    try:
        if "-" in text:
            return datetime.fromisoformat(text).astimezone(UTC).isoformat()
        of_day = time_of_day(text)
    except ValueError:
        raise UsageError(f"`{text}` is not a time: write 14:03, 14:03:20, or 2026-11-22T14:03:20") from None
    begin = datetime.combine(now.date(), of_day, now.tzinfo)
    if begin > now:
        begin -= timedelta(days=1)
    length = timedelta(minutes=1) if text.count(":") == 1 else timedelta(seconds=1)
    return (begin + length - timedelta(milliseconds=1)).astimezone(UTC).isoformat()


def configure_question(parser: argparse.ArgumentParser) -> None:
    """Add the options of a question about the past: the exhibition, the time and the output format."""
    configure_reach(parser)
    parser.add_argument("--at", metavar="T", help="the time to ask about, such as 14:03 or 14:03:20 (default: now)")
    configure_format(parser)


def put(
    options: argparse.Namespace, question: OperatorRequest, shown: Callable[[dict[str, Any]], Iterator[str]]
) -> int:
    """Put a question to a running exhibition, or else to the project's journal, and print the answer.

    Return 0, or 1 if the question was refused.
    """
    at = moment(options.at, datetime.now()) if options.at else None
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
        found: dict[str, Any] = next(send_request(reached.bus, operator_key(reached.robot), body, OPERATOR_ANSWERS))
    finally:
        reached.bus.close()
    if found.get("kept") == "later":
        return answer_from_journal(options.project, question.ask, what, at, found["reason"], options.robot_name)
    return found
