"""The messages on a bus in a visit, as lines.

An id, a time of day and a process's own numbers differ from run to run: only whether they are there is written.
Telemetry, of which each message replaces the one before, is summed up for each second: how many of each key in which
order, with a digest of all bodies, and the first body of each key in full.
"""

import re
from collections import Counter
from collections.abc import Callable, Mapping
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import lumen
import lumen.bus
from lumen.bus import Bus, Message
from lumen.ports import Ability, Outgoing
from tests.golden.texts import digest, in_one_line

ID = re.compile(r"[0-9a-f]{10}-[0-9]+(/alias)?")
DATE = re.compile(r"\d{4}-\d\d-\d\dT[0-9:.]+(Z|[+-]\d\d:\d\d)")
LONG_AGO = datetime(2020, 1, 1, tzinfo=UTC).timestamp()
VISITS = {"tour": ("visitor", 42.0), "museum": ("visit", 42.0)}
"""The story that is played of each project, and for how long [s]: greeting, name, answers; lamps, walks, stops."""


def key_of(project: lumen.Project, route: str) -> str:
    """Return the key of a route."""
    return project.routes[route].key.replace("{robot}", project.robot)


def telemetry_of(project: lumen.Project) -> frozenset[str]:
    """Return the keys whose messages replace each other: those of routes that keep one, or are sent every so often."""
    routes = [row for row in project.routes.values() if row.keep == 1 or row.every]
    keys = [key for row in routes for key in (row.key, row.alias) if key]
    return frozenset(key.replace("{robot}", project.robot) for key in keys)


class Transcript:
    """Lines about messages, in their order; `now` is the exhibition's time [s]."""

    def __init__(self, telemetry: frozenset[str], now: Callable[[], float] = lambda: 0.0) -> None:
        self.lines: list[str] = []
        self.now, self._telemetry = now, telemetry
        self._second = 0
        self._counts: Counter[str] = Counter()
        self._order: list[str] = []
        self._seen: set[str] = set()

    def add(self, verb: str, key: str, said: Mapping[str, Any]) -> None:
        """Add a message, or something else that happened under a key."""
        if int(self.now()) != self._second:
            self.sum_up()
        told = {name: steady(value) for name, value in said.items() if value not in ("", None)}
        line = f"{verb} {key} {in_one_line(told)}"
        if key in self._telemetry and verb in ("publish", "receive"):
            self._counts[f"{verb} {key}"] += 1
            self._order.append(line)
            if f"{verb} {key}" in self._seen:
                return
            self._seen.add(f"{verb} {key}")
        self.lines.append(f"{self.now():.2f} {line}")

    def receive(self, message: Message) -> None:
        """Add a message as a subscriber receives it; of id and time only that they are there, of the body a digest."""
        said = message._asdict() | {"id": bool(message.id), "time": message.time > 0}
        said["body"] = digest([in_one_line(steady(message.body))])
        self.add("receive", said.pop("key"), said)

    def time(self) -> float:
        """Return the exhibition's time [s]."""
        return self.now()

    def sum_up(self) -> None:
        """End a second: add a line that sums up its telemetry."""
        if self._order:
            counts = ", ".join(f"{number} {what}" for what, number in sorted(self._counts.items()))
            self.lines.append(f"second {self._second}: {counts}; {digest(self._order)}")
        self._counts.clear()
        self._order.clear()
        self._second = int(self.now())


def steady(data: Any) -> Any:
    """Return JSON data with `ID` in place of an id of a message, and `DATE` and `NOW` in place of a time of day."""
    match data:
        case dict():
            return {key: steady(value) for key, value in data.items()}
        case list() | tuple():
            return [steady(value) for value in data]
        case str() if ID.fullmatch(data):
            return "ID"
        case str() if DATE.fullmatch(data):
            return "DATE"
        case float() if data > LONG_AGO:
            return "NOW"
    return data


class TranscribedBus(Bus):
    """A bus that writes down each call."""

    def __init__(self, bus: Bus, transcript: Transcript) -> None:
        self._bus, self._transcript = bus, transcript

    def carry(self, routes: Mapping[str, Any]) -> None:
        self._transcript.add("carry", str(len(routes)), {key: _carried(row) for key, row in routes.items()})
        self._bus.carry(routes)

    def prepare(self, routes: Mapping[str, Any]) -> None:
        self._transcript.add("prepare", str(len(routes)), {"keys": list(routes)})
        self._bus.prepare(routes)

    def subscribe(self, pattern: str, handler: Callable[[Message], None]) -> Callable[[], None]:
        self._transcript.add("subscribe", pattern, {})
        undo = self._bus.subscribe(pattern, handler)

        def undone() -> None:
            self._transcript.add("unsubscribe", pattern, {})
            undo()

        return undone

    def send(self, message: Outgoing) -> None:
        key, body, reply_to, correlation_id, ttl, id, sender, sent_at, cause = message
        said = {"ttl": ttl, "reply_to": reply_to, "body": body, "sender": sender, "cause": cause}
        said |= {"id": bool(id) or None, "time": bool(sent_at) or None}
        self._transcript.add("publish", key, {**said, "correlation_id": bool(correlation_id) or None})
        self._bus.send(message)

    def reply(self, message: Message, body: Any) -> None:
        self._bus.reply(message, body)

    def close(self) -> None:
        self._bus.close()

    def ability(self, kind: type[Ability]) -> Ability | None:
        return self._bus.ability(kind)


def _carried(route: Any) -> str:
    return f"{route.carried} {route.direction} keep {route.keep} ttl {route.lifetime}"


def write_down(root: Path, bus: Bus, transcript: Transcript, seconds: float) -> None:
    """Run the project's exhibition on a bus, with its story, for so long [s] at most."""
    story, _ = VISITS[root.name]
    with lumen.open(root, bus=TranscribedBus(bus, transcript), story=story) as exhibition:
        transcript.now = lambda: exhibition.now
        exhibition.run(seconds)
    transcript.sum_up()
