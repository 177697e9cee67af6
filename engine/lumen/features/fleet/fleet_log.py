"""The incidents and counts of a fleet at its centre, saved together with the next offset in the stream."""

import time
from collections import deque
from collections.abc import Mapping
from typing import Any

from lumen.bus.brokers import StreamEntry
from lumen.features.fleet.rollouts.presence import HOURS, MAX_TEXT, measures_from, rates
from lumen.features.fleet.settings import FleetMeasure
from lumen.language.fleet_keys import INCIDENT, NUMBERS, robot_of
from lumen.project.home import Home

FILE = "log.json"
MAX_INCIDENTS, MAX_IDS, MAX_BUNDLES = 200, 2000, 4
SAVE_PERIOD = 10.0
"""The time between two writes [s].

After a process is killed, the next process rereads the messages since the last write, and adds them to the saved
counts.
"""


class FleetLog:
    """The log in a centre's home; `next` is the stream's next offset to read.

    Repeated messages are recognised by their ids, because a broker's shovel resends unconfirmed messages.
    """

    def __init__(self, home: Home) -> None:
        self._home, self._saved, self._changed = home, time.monotonic(), False
        self.next = 0
        self.incidents: deque[dict[str, Any]] = deque(maxlen=MAX_INCIDENTS)
        self.kinds: dict[str, int] = {}
        self._ids: dict[str, None] = {}
        self._numbers: dict[str, dict[str, Mapping[str, float]]] = {}
        match home.read_json(FILE):
            case {
                "next": int(next),
                "incidents": list(incidents),
                "kinds": dict(kinds),
                "ids": list(ids),
                "numbers": dict(numbers),
            }:
                self.next, self.kinds, self._numbers, self._ids = next, kinds, numbers, dict.fromkeys(ids)
                self.incidents.extend(incidents)

    def take(self, entry: StreamEntry, now: float) -> str:
        """Count a message that arrived at `now` [s since 1970]; return a line about an incident, else an empty text."""
        if entry.offset >= 0:
            self.next, self._changed = entry.offset + 1, True
        if entry.id and entry.id in self._ids:
            return ""
        robot, at = robot_of(entry.key), entry.time or now
        match entry.body:
            case {"kind": str(kind), "text": str(text)} if entry.key.startswith(f"{INCIDENT}."):
                kind, text = kind[:40], text[:MAX_TEXT]
                self.incidents.append({"robot": robot, "kind": kind, "text": text, "at": round(at)})
                self.kinds[kind] = self.kinds.get(kind, 0) + 1
                told = f"{robot}: {kind}: {text}"
            case {"bundle": str(bundle), "since": int() | float() as since, "counts": counts} if (
                entry.key.startswith(f"{NUMBERS}.") and (found := measures_from(counts)) is not None
            ):
                of_bundle = self._numbers.pop(bundle[:MAX_TEXT], {})
                self._numbers[bundle[:MAX_TEXT]] = {**of_bundle, f"{robot} {round(since)}": found}
                told = ""
            case _:
                return ""
        self._changed = True
        self._ids |= {entry.id: None} if entry.id else {}
        for old in list(self._ids)[:-MAX_IDS]:
            del self._ids[old]
        for old in list(self._numbers)[:-MAX_BUNDLES]:
            del self._numbers[old]
        return told

    def numbers(self, measures: Mapping[str, FleetMeasure]) -> list[dict[str, Any]]:
        """Return each bundle's number of robots, hours and rates of `measures`, the last reported bundle last."""
        return [
            {
                "bundle": bundle,
                "robots": len({name.partition(" ")[0] for name in rows}),
                "hours": round(sum(row.get(HOURS, 0.0) for row in rows.values()), 2),
                "measures": rates(rows.values(), measures),
            }
            for bundle, rows in self._numbers.items()
        ]

    def save(self, *, now: bool = False) -> str:
        """Write a changed log, immediately with `now`, else at most every `SAVE_PERIOD`.

        Return the error, else an empty string.
        """
        if not self._changed or not (now or time.monotonic() - self._saved > SAVE_PERIOD):
            return ""
        self._saved, self._changed = time.monotonic(), False
        data = {
            "next": self.next,
            "incidents": list(self.incidents),
            "kinds": self.kinds,
            "ids": list(self._ids),
            "numbers": self._numbers,
        }
        return self._home.write_json(FILE, data)
