"""`lumen status`: how a running exhibition is."""

import argparse
import json
from collections.abc import Iterator
from datetime import UTC, datetime
from typing import Any

from lumen.app.asking import OPERATOR_ANSWERS, ask, operator_key
from lumen.cli.printing import clock_time
from lumen.cli.reach import configure_reach, names_meant, reach


def configure(parser: argparse.ArgumentParser) -> None:
    configure_reach(parser)
    parser.add_argument("--format", choices=("text", "json"), default="text", help="how to print it (default: text)")


def run(options: argparse.Namespace) -> int:
    """0 where one runs and says how it is."""
    names = names_meant(options)
    found = [_status(options, name) for name in names]
    if options.format == "json":
        print(json.dumps(found[0] if len(names) == 1 else {"robots": found}, ensure_ascii=False))
        return 0
    for i, status in enumerate(found):
        if i:
            print()
        for name, text in _lines(status, datetime.now(UTC)):
            text = "".join(sign if sign.isprintable() else "\N{REPLACEMENT CHARACTER}" for sign in text)
            print(f"{name:<9} {text}")
    return 0


def _status(options: argparse.Namespace, name: str) -> dict[str, Any]:
    """What the exhibition of that robot says of itself."""
    options.robot_name = name
    reached = reach(options)
    try:
        found: dict[str, Any] = next(ask(reached.bus, operator_key(reached.robot), {"ask": "status"}, OPERATOR_ANSWERS))
        return found
    finally:
        reached.bus.close()


def _lines(status: dict[str, Any], now: datetime) -> Iterator[tuple[str, str]]:
    """What a person reads, a name and a text each; what is as it should be is left out."""
    yield str(status["robot"]), f"in {', '.join(status['configuration'])}"
    yield "since", _ago(status["since"], now)
    yield "visitor", f"{status['visitor'] or 'no name known'}, spoken to in {status['language']}"
    if status["battery"] is not None:
        yield "battery", f"{status['battery']} %"
    for timer in status["timers"]:
        yield "timer", f"{timer['event']}: due {_ahead(timer['due'], now)}"
    if status["stopped"]:
        yield "stopped", f"by {status['stopped_by']}: nobody moves it until `lumen resume`"
    if status["realtime"] < 1.0:
        yield "time", f"{status['realtime']:.2f} of real time is kept"
    if reload := status["last_reload"]:
        yield "reload", f"{reload['verdict']} {_ago(reload['at'], now)}: {reload['text']}"
    yield "files", str(status["bundle"])[:16]


def _ago(text: str, now: datetime) -> str:
    at = datetime.fromisoformat(text)
    return f"{at.astimezone():%H:%M:%S}, {clock_time(max(0.0, (now - at).total_seconds()))} ago"


def _ahead(text: str, now: datetime) -> str:
    at = datetime.fromisoformat(text)
    return f"{at.astimezone():%H:%M:%S}, in {clock_time(max(0.0, (at - now).total_seconds()))}"
