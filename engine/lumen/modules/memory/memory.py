"""Writes a journal of what the bus carries, knows visitors by their names, and answers questions about both."""

import time
from collections import deque
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any

from lumen.errors import ModuleError
from lumen.language.modules import MEMORY
from lumen.language.projects import Project
from lumen.modules.memory.store import JournalEntry, Store
from lumen.modules.module import DAY, KEEP_DAYS, Module
from lumen.ports import Bus, Message, MessageHandler

DATABASE_FILE = "memory.db"
VISITOR_KEY = "visitor"
"""The key of the behaviour's context that holds the visitor's name, where `lumen.yaml` does not say."""
MAX_PENDING_ENTRIES = 10_000
"""Entries that wait for a database that can't be written; then the oldest are dropped."""
RETRY_INTERVAL = 1.0
"""How often a database that can't be written is tried again [s]."""
EXPIRY_INTERVAL = 3_600.0
"""How often what is too old is deleted [s]."""
SENSES = ("joint", "sonar", "tactile", "battery")


class Memory(Module):
    """The database module. `file` None keeps everything in this process; `clock` gives the date [s since 1970].

    Entries are one of `heard`, `said`, `state`, `visitor`, `recognised`, `gender`, `fact`, a sense's name, or what
    somebody else calls theirs on the route `journal`.
    """

    name = MEMORY

    def __init__(
        self,
        project: Project,
        bus: Bus,
        tell: Callable[[str], None],
        file: Path | None,
        clock: Callable[[], float] = time.time,
    ) -> None:
        super().__init__(project, bus, tell)
        self._store, self._clock = Store(file), clock
        self._pending: deque[JournalEntry] = deque(maxlen=MAX_PENDING_ENTRIES)
        self._visitor, self._expired = "", 0.0
        self._sampled: dict[str, float] = {}
        self._met: deque[str] = deque(maxlen=MAX_PENDING_ENTRIES)

    def hears(self) -> Mapping[str, MessageHandler]:
        heard: dict[str, MessageHandler] = {
            "state": self._state,
            "heard": lambda m: self._note("heard", m.body, "result"),
            "recognised": lambda m: self._note("recognised", m.body, "name"),
            "gender": lambda m: self._note("gender", m.body, "gender"),
            "fact": self._fact,
            "journal": self._asked,
        }
        if self.settings.options.get("sample"):
            heard.update({sense: partial(self._sample, sense) for sense in SENSES})
        return heard

    def idle(self) -> float | None:
        """Write what waits, and delete what is older than it may be."""
        now = self._clock()
        try:
            self._write()
            if now - self._expired > EXPIRY_INTERVAL:
                self._store.expire(now - float(self.settings.options.get("keep", KEEP_DAYS)) * DAY)
                self._expired = now
        except ModuleError as error:
            self.tell(str(error))
            return RETRY_INTERVAL
        return EXPIRY_INTERVAL

    def end(self) -> None:
        try:
            self._write()
        except ModuleError as error:
            self.tell(f"{error} ({len(self._pending)} entries are lost)")
        self._store.close()

    def _write(self) -> None:
        while self._met:
            self._store.met(self._met[0], self._clock())
            self._met.popleft()
        if self._pending:
            entries = list(self._pending)
            self._store.add(entries)
            for _ in entries:
                self._pending.popleft()
            self.well()

    def _note(self, kind: str, body: Any, text: str, data: Mapping[str, Any] | None = None) -> None:
        """An entry; `text` names the field of the body that says it in a word."""
        rest = {k: v for k, v in body.items() if k != text} if data is None else data
        self._pending.append(
            JournalEntry(self._clock(), self.project.robot, self._visitor, kind, str(body.get(text, "")), rest)
        )

    def _state(self, message: Message) -> None:
        match message.body:
            case {"robot": str(robot)} if robot != self.project.robot:
                return
            case {"command": {"verb": "say", "text": str(text)}}:
                self._note("said", {"text": text}, "text")
            case {"context": dict(context)}:
                self._meet(str(context.get(self.settings.options.get("visitor", VISITOR_KEY)) or ""))
                if entered := message.body.get("entered"):
                    data = {"event": message.body.get("event", "")}
                    self._note("state", {"text": ", ".join(entered)}, "text", data)

    def _meet(self, name: str) -> None:
        """The visitor in front of the robot, by the name that the behaviour knows."""
        if name == self._visitor:
            return
        self._visitor = name
        if name:
            self._met.append(name)
            self._note("visitor", {"name": name}, "name")

    def _sample(self, sense: str, message: Message) -> None:
        """Senses are noted once in every so many seconds, as Lumen's database did at 1 Hz."""
        now, every = self._clock(), float(self.settings.options["sample"])
        if now - self._sampled.get(sense, 0.0) >= every:
            self._sampled[sense] = now
            self._note(sense, {}, "", message.body)

    def _fact(self, message: Message) -> None:
        body = message.body if isinstance(message.body, dict) else {}
        name, data = str(body.get("name", "")).strip(), body.get("data") or {}
        match body.get("method"):
            case "remember":
                self._answer(message, lambda: self._store.met(name, self._clock(), data) or {})  # type: ignore[func-returns-value]
            case "recall":
                self._answer(message, lambda: {"visitor": self._store.visitor(name)})
            case "list":
                self._answer(message, lambda: {"visitors": self._store.visitors()})
            case "forget":
                self._answer(message, lambda: self._forget(name))
            case _:
                self._note("fact", body, "")
                self._answer(message, dict)

    def _forget(self, name: str) -> dict[str, Any]:
        if not name:
            raise ModuleError("`forget` takes a `name`")
        self._write()
        if self._visitor.casefold() == name.casefold():
            self._visitor = ""
        try:
            visitors, entries = self._store.forget(name)
        finally:
            self.publish("forgotten", {"name": name})
        return {"visitors": visitors, "entries": entries}

    def _asked(self, message: Message) -> None:
        """An entry of somebody else's, or the question for some."""
        body = message.body if isinstance(message.body, dict) else {}
        if body.get("method") != "read":
            data = {k: v for k, v in body.items() if k not in ("method", "kind", "text")}
            self._note(str(body.get("kind", "entry")), body, "text", data)
            self._answer(message, dict)
            return
        since, visitor, limit = body.get("since", 0.0), str(body.get("visitor", "")), body.get("limit", 100)
        self._answer(message, lambda: {"entries": self._store.journal(since=since, visitor=visitor, limit=limit)})

    def _answer(self, message: Message, work: Callable[[], Mapping[str, Any]]) -> None:
        """Do it with all written that came before, and tell who asked how it went; the operator where it failed."""
        try:
            self._write()
            found = work()
        except ModuleError as error:
            self.reply(message, {"ok": False, "reason": str(error)})
            raise
        self.reply(message, {"ok": True, **found})
