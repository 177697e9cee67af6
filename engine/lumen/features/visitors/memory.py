"""Writes a journal of the bus's messages, remembers visitors by name, and answers requests about both."""

import time
from collections import deque
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any, Self

from lumen.errors import ModuleError
from lumen.features.visitors.store import Forgotten, JournalEntry, Store
from lumen.features.visitors.visit import JournalEnd, Visit
from lumen.language.modules import MEMORY, VISITOR_KEY
from lumen.language.people import PersonName, name_key
from lumen.language.projects import Project
from lumen.ports import Bus, Message, MessageHandler
from lumen.run.forgetting.added import Forgetting, ForgottenPlace
from lumen.run.forgetting.files import attempt
from lumen.run.module import DAY, KEEP_DAYS, Module

DATABASE_FILE = "memory.db"
"""The name of the database file in an exhibition's home."""
MAX_PENDING_ENTRIES = 10_000
"""The maximum number of entries that wait for an unwritable database; beyond it, the oldest are dropped."""
RETRY_INTERVAL = 1.0
"""The time after which writing to an unwritable database is tried again [s]."""
EXPIRY_INTERVAL = 3_600.0
"""The minimum time between two deletions of old entries [s]."""
SENSES = ("joint", "sonar", "tactile", "battery")


class Memory(Module):
    """The database module. Without a `file`, data is kept in this process; `clock` returns the time [s since 1970].

    An entry's kind is `heard`, `said`, `state`, `visitor`, `recognised`, `gender`, `fact`, a sense's name, or the kind
    given by another module on the route `journal`.
    """

    name = MEMORY

    @classmethod
    def make(cls, project: Project, bus: Bus, tell: Callable[[str], None], folder: Path | None) -> Self:
        """Make the module with its database in `folder`, or without a file if `folder` is None."""
        return cls(project, bus, tell, folder and folder / DATABASE_FILE)

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
        self._visit, self._expired = Visit(), 0.0
        self._sampled: dict[str, float] = {}
        self._met: deque[str] = deque(maxlen=MAX_PENDING_ENTRIES)
        self._owed: dict[str, str] = {}

    def hears(self) -> Mapping[str, MessageHandler]:
        """Return the message handlers by route."""
        heard: dict[str, MessageHandler] = {
            "state": self._state,
            "heard": lambda m: self._note("heard", m.body, "result"),
            "recognised": lambda m: self._note("recognised", m.body, "name"),
            "gender": lambda m: self._note("gender", m.body, "gender"),
            "fact": self._fact,
            "journal": self._asked,
            "forgotten": self._unlearn,
        }
        if self.settings.options.get("sample"):
            heard.update({sense: partial(self._sample, sense) for sense in SENSES})
        return heard

    def idle(self) -> float | None:
        """Write waiting entries, and delete expired ones; return the time until the next call [s]."""
        now = self._clock()
        try:
            self._settle()
            if now - self._expired > EXPIRY_INTERVAL:
                self._store.expire(now - float(self.settings.options.get("keep", KEEP_DAYS)) * DAY)
                self._expired = now
        except ModuleError as error:
            self.tell(str(error))
            return RETRY_INTERVAL
        return EXPIRY_INTERVAL

    def end(self) -> None:
        """Write waiting entries, report lost ones, and close the database."""
        try:
            self._settle()
        except ModuleError as error:
            self.tell(f"{error} (lost entries: {len(self._pending)})")
        self._store.close()

    def _settle(self) -> None:
        """Write waiting visits and entries, and retry failed deletions. Raises ModuleError if that fails."""
        self._write()
        for name in list(self._owed.values()):
            self._delete(name)

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

    def _note(
        self, kind: str, body: Any, text: str, data: Mapping[str, Any] | None = None, *, theirs: bool = True
    ) -> None:
        """Add an entry to be written; `text` names the body's field with the main text.

        Entries that name a forgotten visitor are left out. During a forgotten visitor's visit, so are all entries about
        the visitor (`theirs`); others, such as sensor readings, are added without a name.
        """
        rest = {k: v for k, v in body.items() if k != text} if data is None else data
        self._live(spoken=theirs and kind != "state")
        said, visit = str(body.get(text, "")), self._visit
        if visit.names_unwanted(said, rest) or (visit.muted and theirs):
            return
        whose = ("", 0) if visit.muted else (visit.visitor, visit.number)
        self._pending.append(JournalEntry(self._clock(), self.project.robot, whose[0], kind, said, rest, whose[1]))

    def _live(self, *, spoken: bool) -> None:
        self._visit.live(self._clock(), self._earlier, spoken=spoken)

    def _earlier(self) -> JournalEnd:
        """Return the end of an earlier run's journal; empty if the database is unreadable (the next write fails)."""
        try:
            return self._store.end()
        except ModuleError:
            return JournalEnd()

    def _state(self, message: Message) -> None:
        match message.body:
            case {"robot": str(robot)} if robot != self.project.robot:
                return
            case {"command": {"verb": "say", "text": str(text)}}:
                self._note("said", {"text": text}, "text")
            case {"context": dict(context)}:
                name = str(context.get(self.settings.options.get("visitor", VISITOR_KEY)) or "")
                self._live(spoken=False)
                if self._visit.meet(name, stepped="entered" in message.body):
                    self._met.append(name)
                    self._note("visitor", {"name": name}, "name")
                if entered := message.body.get("entered"):
                    data = {"event": message.body.get("event", "")}
                    self._note("state", {"text": ", ".join(entered)}, "text", data)

    def _sample(self, sense: str, message: Message) -> None:
        """Record a sense's reading if the configured time `sample` [s] has passed since the last one."""
        now, every = self._clock(), float(self.settings.options["sample"])
        if now - self._sampled.get(sense, 0.0) >= every:
            self._sampled[sense] = now
            self._note(sense, {}, "", message.body, theirs=False)

    def _fact(self, message: Message) -> None:
        body = message.body if isinstance(message.body, dict) else {}
        name, data = str(body.get("name", "")).strip(), body.get("data") or {}
        match body.get("method"):
            case "remember":
                self._answer(message, lambda: self._remember(name, data))
            case "recall":
                self._answer(message, lambda: {"visitor": self._store.visitor(name)})
            case "list":
                self._answer(message, lambda: {"visitors": self._store.visitors()})
            case "forget":
                self._answer(message, lambda: self._forget(name))
            case _:
                self._note("fact", body, "", theirs=False)
                self._answer(message, dict)

    def _remember(self, name: str, data: Mapping[str, Any]) -> dict[str, Any]:
        _check_name(name, "remember")
        self._store.met(name, self._clock(), data)
        return {}

    def _forget(self, name: str) -> dict[str, Any]:
        _check_name(name, "forget")
        try:
            found = self._delete(name)
        finally:
            self.publish("forgotten", {"name": name})
        counted = {"visitors": found.visitors, "entries": found.entries}
        return {**counted, "others": list(found.others)} if found.others else counted

    def _unlearn(self, message: Message) -> None:
        """Forget a visitor at the request of this module or of a program that deletes files."""
        match message.body:
            case {"name": str(name)} if name_key(name):
                self._delete(name)

    def _delete(self, name: str) -> Forgotten:
        """Forget a visitor now; if that raises ModuleError, try again when the database can be written."""
        self._owed[name_key(name)] = name
        if self._visit.is_with(name):
            self._visit.forget(name)
        person = PersonName(name)
        self._met = deque((met for met in self._met if name_key(met) != person.key), MAX_PENDING_ENTRIES)
        self._write()
        found = self._store.forget(name)
        if self._visit.number and self._visit.number in found.visits:
            self._visit.forget(name)
        del self._owed[person.key]
        return found

    def _asked(self, message: Message) -> None:
        """Record another module's entry, or answer its request for entries."""
        body = message.body if isinstance(message.body, dict) else {}
        if body.get("method") != "read":
            data = {k: v for k, v in body.items() if k not in ("method", "kind", "text")}
            self._note(str(body.get("kind", "entry")), body, "text", data, theirs=False)
            self._answer(message, dict)
            return
        since, visitor, limit = body.get("since", 0.0), str(body.get("visitor", "")), body.get("limit", 100)
        self._answer(message, lambda: {"entries": self._store.journal(since=since, visitor=visitor, limit=limit)})

    def _answer(self, message: Message, work: Callable[[], Mapping[str, Any]]) -> None:
        """Write all earlier entries, do the work, and reply with the result.

        If a step raises ModuleError, reply with the reason and raise the error again.
        """
        try:
            self._write()
            found = work()
        except ModuleError as error:
            self.reply(message, {"ok": False, "reason": str(error)})
            raise
        self.reply(message, {"ok": True, **found})


def _check_name(name: str, method: str) -> None:
    """Raise ModuleError if the name is empty or has only spaces and invisible characters."""
    if not name_key(name):
        raise ModuleError(f"`{method}` takes a `name`")


def forget_in_database(folder: Path, name: str, found: Forgetting) -> None:
    """Forget a visitor in a home's database; add the counts and other visitors whose names contain it to `found`."""

    def work() -> None:
        store = Store(file)
        try:
            gone = store.forget(name)
        finally:
            store.close()
        found.visitors += gone.visitors
        found.entries += gone.entries
        found.others = gone.others
        if gone.visitors or gone.entries:
            counts = f"visitors: {gone.visitors}, entries of the journal: {gone.entries}"
            found.deleted.append(ForgottenPlace(file.name, counts))

    file = folder / DATABASE_FILE
    attempt(found, file, work)
