"""Saved files on a running exhibition: taken where they are good, reported where they are not."""

import logging
from collections import deque
from collections.abc import Callable, Iterable
from dataclasses import replace
from pathlib import Path

from lumen.buses.validated import by_key
from lumen.cli.rehearsal import Rehearsal
from lumen.cli.reloading.bulletin import Bulletin
from lumen.cli.reloading.judging import BUDGET, Judge, Judged, fault_of, told
from lumen.cli.reloading.jury import Here, Jury
from lumen.cli.reloading.orders import COMMAND, WAITING, Order, answering, order_from
from lumen.cli.reloading.records import Records
from lumen.cli.reloading.staging import Staged, Staging
from lumen.cli.reloading.telling import Herald
from lumen.cli.show import Show
from lumen.cli.transcript import Transcript
from lumen.errors import BusError, UsageError
from lumen.interpreters.changes import changes, live
from lumen.language.events import Event
from lumen.language.projects import Project
from lumen.loading.files import read_files
from lumen.ports import Message
from lumen.runtime.watcher import QUIET, FileWatcher, SavedFiles

_log = logging.getLogger(__name__)

MODES = ("auto", "manual", "off")
"""Take saved files at once; only judge them, and wait for `lumen reload --apply`; leave them alone."""


class Reloading:
    """Has saved files judged, and stages every good bundle; hears what operators ask for.

    `apart` is whether files are judged in another process. `quiet` [s] and `budget` [s] are those of the watcher and of
    stories; `applied` is told of each bundle that comes in force. `seen` is the hash of files that are there and not to
    be taken until they change, where those are not the ones that run.
    """

    def __init__(
        self,
        show: Show,
        transcript: Transcript,
        *,
        mode: str = "auto",
        records: Records | None = None,
        applied: Callable[[Project], None] = lambda _: None,
        seen: str = "",
        apart: bool = False,
        quiet: float = QUIET,
        budget: float = BUDGET,
    ) -> None:
        self._show, self._mode = show, mode
        self._records = records or Records(None)
        self._herald = Herald(show, transcript, self._records)
        self._staging = Staging(show, self._herald, self._records, applied)
        self._bus = show.exhibition.bus
        self._came: deque[Message] = deque(maxlen=WAITING)
        project = show.exhibition.project
        self._court = (Jury if apart else Here)(Path(project.root))
        judge = Judge(self._court, lambda: self._running, budget)
        self._watcher: FileWatcher[Judged | list[Rehearsal]] = FileWatcher(
            Path(project.root),
            read_files(Path(project.root)),
            lambda saved: self._judge(judge, saved),
            hash=seen or project.hash,
            quiet=quiet,
            hints=mode != "off",
            leisure=lambda judged, urgent: self._advise(judge, judged, urgent),
            noticed=self._court.begin,
        )
        self._undo = self._bus.subscribe(COMMAND, self._came.append)
        self._watcher.start()

    @property
    def last(self) -> Bulletin | None:
        """What was told last."""
        return self._herald.last

    @property
    def _running(self) -> Project:
        return self._show.exhibition.project

    def begin(self, news: Iterable[Bulletin]) -> None:
        """The exhibition starts; `news` are the reloads that this is."""
        self._records.begin(self._running.hash)
        for bulletin in news:
            self._herald.tell(bulletin)

    def close(self) -> None:
        self._undo()
        self._watcher.close()
        self._court.close()

    def tick(self, now: float) -> None:
        """Take what was asked, see what the watcher found, and apply what is staged.

        A fault of ours in any of that costs the reload, and nothing else.
        """
        try:
            self._tick(now)
        except Exception:
            _log.exception("the saved files could not be taken")
            self._staging.drop()

    def _tick(self, now: float) -> None:
        while self._came:
            self._hear(self._came.popleft())
        while not self._watcher.results.empty():
            found = self._watcher.results.get()
            if isinstance(found, Judged):
                self._take(found)
            else:
                self._warn(found)
        self._staging.tick(now)

    def _judge(self, judge: Judge, saved: SavedFiles) -> Judged:
        """On the watcher's thread: routes that come with the files are made ready here, where nobody has to wait."""
        judged = Judged(saved, "")
        try:
            judged = judge(saved)
            if judged.good and judged.project:
                self._bus.prepare(by_key(judged.project))
                self._records.store(saved.files)
        except BusError as error:
            return replace(judged, fault=f"the bus refuses its routes: {error}")
        except Exception as error:
            return replace(judged, fault=fault_of(error))
        return judged

    def _advise(self, judge: Judge, judged: Judged | list[Rehearsal], urgent: Callable[[], bool]) -> None:
        """On the watcher's thread, when there is nothing more urgent."""
        if isinstance(judged, Judged) and (failed := judge.advise(judged, urgent)):
            self._watcher.results.put(failed)

    def _warn(self, failed: list[Rehearsal]) -> None:
        for rehearsal in failed:
            self._herald.line(f"the story `{rehearsal.story.name}` does not hold with these files: {told(rehearsal)}")

    def _hear(self, message: Message) -> None:
        try:
            order = order_from(message, self._bus)
        except UsageError as error:
            answering(message, self._bus)(self._answer("refused", str(error)).to_json())
            return
        staging = self._staging
        if order.verb == "stop":
            self._show.exhibition.happen(Event("stop", {}))
            order.answer(self._answer("stopped", "the behaviour is told to stop").to_json())
        elif order.verb == "status":
            order.answer(self._status().to_json())
        elif self._mode == "off":
            self._herald.tell(self._answer("refused", "it was started with --reload off"), [order])
        elif order.verb in ("reload", "dry-run"):
            self._watcher.ask(order)
        elif order.verb == "rollback" and (before := staging.probation.before):
            back = live(self._running, before)
            staging.stage(Staged(back, changes(self._running, back), who="command", back=True), order)
        elif order.verb == "apply" and staging.staged:
            staging.stage(staging.staged, order)
        else:
            nothing = "to go back to" if order.verb == "rollback" else "staged"
            self._herald.tell(self._answer("refused", f"there is nothing {nothing}"), [order])

    def _take(self, judged: Judged) -> None:
        """Decide on what was judged."""
        order = judged.saved.asked if isinstance(judged.saved.asked, Order) else None
        who, orders, staging = "command" if order else "files", [order] if order else [], self._staging
        if not judged.good or judged.project is None:
            staging.drop()
            self._herald.tell(self._verdict("refused", who, judged, judged.fault), orders)
            return
        project = live(self._running, judged.project)
        same = judged.running is self._running
        staged = Staged(project, judged.changes if same else changes(self._running, project), judged, who)
        if order and order.verb == "dry-run" and judged.hash != self._running.hash:
            staging.dry_run(staged, order)
        elif judged.hash == self._running.hash:
            staging.drop()
            self._herald.tell(self._verdict("unchanged", who, judged), orders)
        elif order or self._mode == "auto":
            staging.stage(staged, order)
        else:
            staging.hold(staged)

    def _verdict(self, verdict: str, who: str, judged: Judged, reason: str = "") -> Bulletin:
        revision = self._staging.revision
        return Bulletin(verdict, who, self._running.hash, judged.hash, revision, judged=judged, reason=reason)

    def _answer(self, verdict: str, reason: str) -> Bulletin:
        hash = self._running.hash
        return Bulletin(verdict, "command", hash, hash, self._staging.revision, reason=reason)

    def _status(self) -> Bulletin:
        staged, last = self._staging.staged, self.last
        waiting = f", waiting: {staged.told}" if staged and staged.told else ", staged" if staged else ""
        bulletin = self._answer("status", f"revision {self._staging.revision} runs ({self._mode}){waiting}")
        bulletin.more = {
            "mode": self._mode,
            "staged": [str(change) for change in staged.changes] if staged else None,
            "waiting": staged.told if staged else "",
            "probation": self._staging.probation.left(self._show.exhibition.clock.now()),
            "last": last.to_json() if last else None,
            "lines": [bulletin.reason, *(last.lines() if last else [])],
        }
        return bulletin
