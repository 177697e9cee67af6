"""The console's view of one robot: its exhibition's answers, senses, processes and files."""

import re
import time
from collections.abc import Mapping
from typing import Any

import orjson

from lumen.features.console.entry_ring import EntryRing
from lumen.language.iso_time import iso_time, time_of
from lumen.language.numbers import is_number
from lumen.run.presence import HERE, LEAVES, LOST_AFTER
from lumen.run.status import SKILL_STATES

MAX_NAMES = 50
"""The maximum number of names that are kept; a robot may still say the name of a visitor who has left."""
LEFT_OUT = "…"


class SpokenNames:
    """The latest names of a robot's visitors. Any thread may call `add`."""

    def __init__(self) -> None:
        self._names: tuple[str, ...] = ()

    def add(self, name: object) -> None:
        """Remember a name; ignore blank or known names and values that are not strings."""
        if isinstance(name, str) and (known := name.strip()) and known not in self._names:
            self._names = (*self._names, known)[-MAX_NAMES:]

    def without(self, text: str) -> str:
        """Return the text with each of these names replaced by `…`, regardless of case."""
        for name in sorted(self._names, key=len, reverse=True):  # longest first: Ani Putri before Ani
            text = re.sub(rf"(?<!\w){re.escape(name)}(?!\w)", LEFT_OUT, text, flags=re.IGNORECASE)
        return text


SILENT_AFTER = 2.5
"""An exhibition that has not answered for this long counts as disconnected [s]."""
CLOCK_TOLERANCE = 0.7
"""Smaller changes of a clock are ignored [s], because an answer's delay can cause them."""
MAX_PROCESSES = 30
MAX_SKILLS = 200
SEEN_FOR = 1.5
"""A face is shown for this long after it was last seen [s]."""
MAX_NAME = 100
NO_NAMES = ("unknown", "face unrecognized", "error cvException")
"""The names that the face recognition reports for an unknown face."""
FOR_NOBODY = ("robot", "connected", "heard", "stopped", "saying", "language", "languages")
"""The keys shown without a role: enough for subtitles and Rest, but no name and nothing that a visitor said."""


class KnownRobot:
    """The console's view of one robot; `version` increases with each change that a page would show.

    `entries` contains the latest entries of the robot's journal.
    """

    def __init__(self, robot: str) -> None:
        self.robot, self.entries = robot, EntryRing(robot)
        self.version = 0
        self.said: dict[str, Any] = {}
        self.files: dict[str, Any] = {}
        self.senses: dict[str, Any] = {}
        self.connected, self._answered = False, 0.0
        self._heard = ""
        self.seen: dict[str, Any] = {"faces": []}
        self._seen: dict[str, Any] = {}
        self._known, self._saw, self._knew = "", 0.0, 0.0
        self._names = SpokenNames()
        self._processes: dict[str, dict[str, Any]] = {}
        self._sensed: dict[str, Any] = {}
        self.joints: Mapping[str, Any] = {}
        self.moved = 0
        self._blocks: dict[bool, tuple[int, bytes]] = {}

    @property
    def position(self) -> int | None:
        """The position of the journal's last entry; None if the exhibition reports none or has written no entry yet."""
        found = self.said.get("position")
        return found if type(found) is int and found >= 0 else None

    def answered(self, said: Mapping[str, Any]) -> None:
        """Store the status that the robot's exhibition has sent."""
        self._answered, self._heard = time.monotonic(), iso_time(time.time())
        self._names.add(said.get("visitor"))
        told = {**said, "ahead": self._ahead(said.get("time"))}
        if not self.connected or {**told, "time": ""} != {**self.said, "time": ""}:  # a new time alone is no change
            self.said, self.connected = told, True
            self.version += 1

    def look(self, up: bool) -> None:
        """Update the connection, lost processes, senses and faces; `up` is True while the bus is connected."""
        silent = time.monotonic() - self._answered > SILENT_AFTER
        if self.connected and (silent or not up):
            self.connected = False
            self.version += 1
        gone = [s for s, said in self._processes.items() if said["state"] != LEAVES and self._away(said)]
        for session in gone:
            self._processes[session]["state"] = LEAVES
            self.version += 1
        seen = self._faces()
        if self.senses != self._sensed or self.seen != seen:
            self.senses, self.seen = dict(self._sensed), seen
            self.version += 1

    def feel(self, sense: str, body: Mapping[str, Any]) -> None:
        """Store the body of a sense's message until `look` passes it to the pages. Any thread may call this."""
        match sense:
            case "battery" | "sonar":
                self._sensed[sense] = {key: value for key, value in body.items() if key != "time"}
            case "face" if is_number(body.get("x")) and is_number(body.get("y")):
                self._seen, self._saw = {"x": body["x"], "y": body["y"]}, time.monotonic()
            case "recognised" if isinstance(name := body.get("name"), str):
                self._known, self._knew = name[:MAX_NAME], time.monotonic()
                if name not in NO_NAMES:
                    self._names.add(self._known)
            case "joint" if isinstance(names := body.get("name"), list):
                self.joints = body
                self.moved += 1
                hot = body.get("temperature")
                if isinstance(hot, list) and len(hot) == len(names):
                    self._sensed["temperatures"] = dict(zip(names, hot, strict=True))

    def present(self, body: Mapping[str, Any]) -> None:
        """Store a process's presence message. Beyond MAX_PROCESSES, the process silent for longest is dropped."""
        session, state = str(body.get("session"))[:40], str(body.get("state"))[:20]
        parts = [str(part)[:40] for part in body.get("parts", ())][:20]
        known = self._processes.get(session)
        if known is None:
            if len(self._processes) >= MAX_PROCESSES:
                self._processes.pop(min(self._processes, key=lambda one: self._processes[one]["at"]))
            known = self._processes[session] = {"parts": parts, "since": iso_time(time.time()), "state": ""}
            known |= {"host": str(body.get("host", ""))[:60], "process": body.get("process")}
        now = {"state": state, "parts": parts, "skills": _skill_states(body.get(SKILL_STATES))}
        if any(known.get(key) != value for key, value in now.items()):
            known |= now
            self.version += 1
        known |= {"heard": iso_time(time.time()), "at": time.monotonic()}

    def lacks(self, part: str) -> bool:
        """Return True if a process had this part, and no running process has it now."""
        parts = [said for said in self._processes.values() if part in said["parts"]]
        return bool(parts) and not any(said["state"] == HERE and not self._away(said) for said in parts)

    def told(self, files: Mapping[str, Any]) -> None:
        """Store the exhibition's answer about its files."""
        if files != self.files:
            self.files = dict(files)
            self.version += 1

    def to_json(self, *, full: bool) -> dict[str, Any]:
        """Return the robot as JSON data: everything if `full`, which needs a role, else the keys in FOR_NOBODY."""
        processes = [{k: v for k, v in said.items() if k != "at"} for said in self._processes.values()]
        said = {"robot": self.robot, **self.said, "connected": self.connected, "heard": self._heard or None}
        said |= {"senses": self.senses, "processes": processes, "files": self.files, "seen": self.seen}
        return said if full else self._for_nobody(said)

    def block(self, *, full: bool) -> bytes:
        """Return the object of `to_json` as a server-sent event, encoded once per version and value of `full`."""
        version, block = self._blocks.get(full, (-1, b""))
        if version != self.version:
            block = b"event: now\ndata: " + orjson.dumps(self.to_json(full=full)) + b"\n\n"
            self._blocks[full] = self.version, block
        return block

    def _for_nobody(self, said: Mapping[str, Any]) -> dict[str, Any]:
        """Return the keys shown without a role; names are removed from the robot's speech."""
        shown = {key: said[key] for key in FOR_NOBODY if key in said}
        if isinstance(saying := shown.get("saying"), Mapping):
            shown["saying"] = {**saying, "text": self._names.without(str(saying.get("text", "")))}
        return shown

    def _faces(self) -> dict[str, Any]:
        """Return the face last seen, if recent, with its position [px of 320 x 240] and name, empty if unknown."""
        now = time.monotonic()
        if now - self._saw > SEEN_FOR:
            return {"faces": []}
        known = self._known if now - self._knew <= SEEN_FOR and self._known not in NO_NAMES else ""
        return {"faces": [{**self._seen, "name": known}]}

    def _ahead(self, told: object) -> float:
        """Return how far the exhibition's clock, which a story can set, is ahead of ours [s].

        An unreadable time, or a change below CLOCK_TOLERANCE, leaves the previous value.
        """
        before = float(self.said.get("ahead", 0.0))
        try:
            ahead = time_of(str(told)) - time.time()
        except ValueError:
            return before
        return before if abs(ahead - before) < CLOCK_TOLERANCE else round(ahead, 1)

    def _away(self, said: Mapping[str, Any]) -> bool:
        return time.monotonic() - float(said["at"]) > LOST_AFTER


def _skill_states(told: object) -> dict[str, dict[str, Any]]:
    """Return the skills' states in a presence message; malformed ones are left out."""
    found: dict[str, dict[str, Any]] = {}
    for name, one in list(told.items())[:MAX_SKILLS] if isinstance(told, Mapping) else ():
        match one:
            case {"state": str(state), "since": str(since), "crashes": int(crashes), "trouble": str(trouble)}:
                texts = {"state": state[:20], "since": since[:40], "trouble": trouble[:300]}
                found[str(name)[:60]] = {**texts, "crashes": crashes}
    return found
