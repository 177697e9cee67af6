"""`lumen topic`: show the messages on the bus of a running exhibition, or send one."""

import argparse
import json
import queue
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import closing
from itertools import pairwise
from typing import Any, NamedTuple

from lumen.bus.bodies import encode
from lumen.bus.brokers import probe_of
from lumen.bus.validated import by_key, validated
from lumen.cli.progress import progress
from lumen.cli.reach import reach
from lumen.cli.tables import table
from lumen.errors import BusClosedError, BusRefusedError, UsageError
from lumen.language.diagnostics import NodePath, did_you_mean
from lumen.language.projects import Project
from lumen.language.routes import Direction, Route
from lumen.lint import check_files
from lumen.ports import Bus, EndsWithExhibition, Message, ReturningBus
from lumen.project.files import read_files
from lumen.project.project_folders import MAIN_FILE
from lumen.project.running_project import running_project
from lumen.project.units import seconds
from lumen.run.asking import LOOK, OPERATOR_ANSWERS

TOPIC_VERBS = {
    "list": "list the routes, and count the messages on them",
    "echo PATTERN": "print messages as they arrive",
    "pub KEY BODY": "send a message, checked against its route's schema; a BODY that is not JSON is sent as text",
    "hz PATTERN": "measure how often messages arrive, and the longest gap",
    "bw PATTERN": "measure the size of messages, and the bytes per second",
}
"""The verbs and their help. A PATTERN is a key (`*` matches one word, `#` any number of them) or a route's name."""
LISTENING = 3.0
SHOWN = 200
BUILT_IN = "comes with Lumen"
"""The origin of a route that no row of lumen.yaml declares."""


class Heard(NamedTuple):
    """A message, and the time of its arrival on the monotonic clock [s]."""

    message: Message
    at: float


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the options of `lumen topic` to its parser."""
    parser.description = "Look at the messages of a running exhibition, on a broker or on this machine, or send one."
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.epilog = "\n".join(["what to do:", *(f"  {verb:14} {what}" for verb, what in TOPIC_VERBS.items())])
    parser.add_argument("what", metavar="WHAT", choices=[verb.split()[0] for verb in TOPIC_VERBS], help="see below")
    parser.add_argument("words", metavar="WORD", nargs="*", help="a PATTERN, or a KEY and a BODY")
    parser.add_argument("--count", metavar="N", type=int, default=0, help="echo: stop after N messages")
    parser.add_argument(
        "--for", dest="span", metavar="TIME", help="how long to listen (default: 3s; echo: until Ctrl-C)"
    )
    parser.add_argument("--wait", metavar="TIME", help="pub: wait this long for an answer, and print it")
    parser.add_argument("--project", metavar="DIR", help="the exhibition's folder (default: this folder or one above)")
    parser.add_argument("--bus", metavar="URL", help="the exhibition's bus (default: LUMEN_BUS, then this machine)")
    parser.add_argument("--format", choices=("text", "json"), default="text", help="output format (default: text)")


def run(options: argparse.Namespace) -> int:
    """Run the given verb; return 0, or for `pub` 1 if no process listens or, with `--wait`, no answer came."""
    _check_words(options)
    project = _project(options)
    reached = reach(options)
    bus = reached.bus
    try:
        if options.what == "pub" and reached.broker:
            _check_right(reached.broker, _key(options.words[0], project))
        return {"list": _list, "echo": _echo, "pub": _pub, "hz": _hz, "bw": _bw}[options.what](options, bus, project)
    finally:
        bus.close()


def _check_words(options: argparse.Namespace) -> None:
    wanted = next(verb.split()[1:] for verb in TOPIC_VERBS if verb.split()[0] == options.what)
    if len(options.words) != len(wanted):
        raise UsageError(f"write `lumen topic {' '.join([options.what, *wanted])}`")


def _check_right(broker: str, key: str) -> None:
    """Raise BusError if the broker does not allow this user to send with this key."""
    if (opened := probe_of(broker)) is None:
        return
    with closing(opened) as probe:
        if reason := probe.writing(key):
            raise BusRefusedError(f"the broker at {probe.address} does not let this user send `{key}`: {reason}")


def _list(options: argparse.Namespace, bus: Bus, project: Project | None) -> int:
    counts: dict[str, int] = {}
    span = _span(options)
    for heard in _measure(bus, "#", span):
        counts[heard.message.key] = counts.get(heard.message.key, 0) + 1
    routes = by_key(project) if project else {}
    rows = []
    for key in sorted({*routes, *counts}):
        route = routes.get(key)
        name, direction, carried = (route.name, route.direction, route.carried) if route else ("", "", "")
        row = {"key": key, "route": name, "direction": direction, "carried": carried, "messages": counts.get(key, 0)}
        row["alias"] = bool(route and key == route.alias)
        rows.append({**row, **(_origin(route, project) if route and project else {"origin": "", "uses": []})})
    if options.format == "json":
        print(json.dumps({"seconds": span, "topics": rows}))
        return 0
    print(table(["key", "route", "direction", "carried", f"in {span:g} s", "origin"], [_cells(row) for row in rows]))
    return 0


def _origin(route: Route, project: Project) -> dict[str, Any]:
    """Return `origin`, the place of the route's row or BUILT_IN, and `uses`, the places that use a built-in route."""

    def line(file: str, where: NodePath) -> str:
        return f"{file}:{project.place(file, where).line}"

    if not route.built_in:
        return {"origin": line(MAIN_FILE, route.where), "uses": []}
    uses = [{"place": line(use.file, use.where), "verb": use.verb} for use in route.uses]
    return {"origin": BUILT_IN, "uses": uses}


def _cells(row: Mapping[str, Any]) -> list[str]:
    name = f"{row['route']} (alias)" if row["alias"] else row["route"]
    uses = ", ".join(f"{use['place']} {use['verb']} it" for use in row["uses"])
    origin = f"{row['origin']}: {uses}" if uses else row["origin"]
    return [row["key"], name, str(row["direction"]), str(row["carried"]), str(row["messages"]), origin]


def _echo(options: argparse.Namespace, bus: Bus, project: Project | None) -> int:
    pattern = _key(options.words[0], project)
    for number, heard in enumerate(_listen(bus, pattern, _span(options) if options.span else None), 1):
        message = heard.message
        if options.format == "json":
            said = {"key": message.key, "body": message.body, "reply_to": message.reply_to}
            print(json.dumps({**said, "correlation_id": message.correlation_id}, ensure_ascii=False), flush=True)
        else:
            print(f"{message.key}  {_short(message.body)}", flush=True)
        if number == options.count:
            break
    return 0


def _pub(options: argparse.Namespace, bus: Bus, project: Project | None) -> int:
    body = _body(options.words[1])
    patience = _seconds(options.wait, "--wait") if options.wait else 0.0
    key, answers = _key(options.words[0], project), queue.SimpleQueue[Any]()
    reached, returned = bus, list[str]()
    if returning := bus.ability(ReturningBus):
        returning.returns(returned.append)
    if project:
        bus = validated(bus, project)
    if patience:
        bus.subscribe(OPERATOR_ANSWERS, lambda message: answers.put(message.body))
    bus.publish(key, body, reply_to=OPERATOR_ANSWERS if patience else "")
    came = _within(answers, patience) if patience else []
    reached.close()  # closing waits for the broker, so afterwards `returned` is complete
    if key in returned:
        print(f"lumen topic: no process listens to `{key}`: {_listeners(key, project)}", file=sys.stderr)
        return 1
    if not patience:
        return 0
    if not came:
        print(f"lumen topic: no answer within {patience:g} s", file=sys.stderr)
        return 1
    print(json.dumps(came[0], ensure_ascii=False) if options.format == "json" else _short(came[0]))
    return 0


def _body(text: str) -> Any:
    """Return the body to send: JSON, or else the text.

    Raises UsageError for text that begins like JSON but is invalid.
    """
    try:
        return json.loads(text)
    except (ValueError, RecursionError) as error:
        if text.lstrip()[:1] in ("{", "[") and not isinstance(error, RecursionError):
            hint = "write it in single quotes, such as '{\"count\": 3}'"
            raise UsageError(f"the BODY begins like JSON but is not valid ({error}): {hint}") from None
        return text


def _within(answers: queue.SimpleQueue[Any], patience: float) -> list[Any]:
    """Return the first answer within this time [s], as a list of one; empty if none came."""
    try:
        return [answers.get(timeout=patience)]
    except queue.Empty:
        return []


def _listeners(key: str, project: Project | None) -> str:
    """Return a hint: to check that the exhibition is running, or the keys that it listens to, the nearest first."""
    routes = by_key(project) if project else {}
    heard = [each for each, route in routes.items() if route.direction is Direction.IN]
    return (
        "check that the exhibition is running" if key in heard else did_you_mean(key, heard, "an exhibition listens to")
    )


def _hz(options: argparse.Namespace, bus: Bus, project: Project | None) -> int:
    times: dict[str, list[float]] = {}
    span = _span(options)
    for heard in _measure(bus, _key(options.words[0], project), span):
        times.setdefault(heard.message.key, []).append(heard.at)
    rows = []
    for key, at in sorted(times.items()):
        gaps = [after - before for before, after in pairwise(at)]
        rate = len(gaps) / (at[-1] - at[0]) if gaps and at[-1] > at[0] else None
        longest = _round(max(gaps, default=None))
        rows.append({"key": key, "messages": len(at), "hz": _round(rate), "longest_gap": longest})
    return _rows(options, span, rows, ["key", "messages", "per second", "longest gap [s]"])


def _bw(options: argparse.Namespace, bus: Bus, project: Project | None) -> int:
    sizes: dict[str, list[int]] = {}
    span = _span(options)
    for heard in _measure(bus, _key(options.words[0], project), span):
        sizes.setdefault(heard.message.key, []).append(len(encode(heard.message.body)))
    rows = []
    for key, size in sorted(sizes.items()):
        mean, rate = round(sum(size) / len(size)), round(sum(size) / span)
        rows.append({"key": key, "messages": len(size), "mean_bytes": mean, "bytes_per_second": rate})
    return _rows(options, span, rows, ["key", "messages", "bytes each", "bytes/s"])


def _rows(options: argparse.Namespace, span: float, rows: list[dict[str, Any]], head: list[str]) -> int:
    if options.format == "json":
        print(json.dumps({"seconds": span, "topics": rows}))
    elif rows:
        print(table(head, [["-" if v is None else str(v) for v in row.values()] for row in rows]))
    else:
        print(f"no message came on `{options.words[0]}` in {span:g} s")
    return 0


def _measure(bus: Bus, pattern: str, span: float) -> Iterator[Heard]:
    """Yield the messages that arrive within `span` [s], and show the progress on a terminal."""
    with progress() as tell:
        yield from _listen(bus, pattern, span, lambda waited: tell(waited, span, "s listened"))


def _listen(
    bus: Bus, pattern: str, span: float | None, tell: Callable[[float], None] = lambda waited: None
) -> Iterator[Heard]:
    """Yield messages until `span` [s] is over or Ctrl-C is pressed; None for no limit.

    `tell` is called with the time since the beginning [s]. Raises BusClosedError if the exhibition ends.
    """
    came: queue.SimpleQueue[Heard] = queue.SimpleQueue()
    undo = bus.subscribe(pattern, lambda message: came.put(Heard(message, time.monotonic())))
    began = time.monotonic()
    end = None if span is None else began + span
    ends = bus.ability(EndsWithExhibition)
    try:
        while end is None or time.monotonic() < end:
            tell(time.monotonic() - began)
            try:
                yield came.get(timeout=LOOK if end is None else max(0.0, min(LOOK, end - time.monotonic())))
            except queue.Empty:
                if ends and ends.gone.is_set():
                    raise BusClosedError("the exhibition has ended") from None
    except KeyboardInterrupt:
        pass
    finally:
        undo()


def _project(options: argparse.Namespace) -> Project | None:
    """Return the project, for its routes; None if its files have errors, since listening needs no project."""
    root = running_project(options.project)
    return check_files(root, read_files(root))[0]


def _key(text: str, project: Project | None) -> str:
    """Return the key of the route of this name, else the text itself. Raises UsageError if it is neither."""
    if project and (route := project.routes.get(text)):
        return route.key_for(project.robot)
    if "." not in text and text not in ("#", "*", "lumen", "avatar"):
        hint = did_you_mean(text, project.routes if project else (), "lumen.yaml has")
        raise UsageError(f"`{text}` is neither a key nor a route: {hint}")
    return text


def _span(options: argparse.Namespace) -> float:
    return _seconds(options.span, "--for") if options.span else LISTENING


def _seconds(text: str, option: str) -> float:
    length = seconds(text)
    if length is None or length <= 0.0:
        raise UsageError(f"invalid `{option} {text}`: write a number and its unit, such as `500ms`, `20s` or `2min`")
    return length


def _round(value: float | None) -> float | None:
    return None if value is None else round(value, 3)


def _short(body: Any) -> str:
    text = body if isinstance(body, str) else json.dumps(body, ensure_ascii=False)
    text = "".join(c if c.isprintable() else "\N{REPLACEMENT CHARACTER}" for c in text)
    return text if len(text) <= SHOWN else f"{text[:SHOWN]} … ({len(text):,} characters)"
