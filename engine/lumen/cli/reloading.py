"""Saved files on a running exhibition: taken where they are good, reported where they are not."""

import logging
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path

from lumen.buses.validated import by_key
from lumen.cli.bulletin import Bulletin, refusal_of, what_for
from lumen.cli.judging import BUDGET, Judge, Judged, told
from lumen.cli.jury import Here, Jury
from lumen.cli.orders import COMMAND, STATUS, WAITING, Order, answering, order_from
from lumen.cli.probation import Probation
from lumen.cli.records import Records
from lumen.cli.rehearsal import Rehearsal
from lumen.cli.show import Show
from lumen.cli.transcript import Transcript
from lumen.errors import BusError, UsageError
from lumen.interpreters.changes import Change, changes, live
from lumen.interpreters.migration import Plan, Refusal, Wait
from lumen.language.events import Event
from lumen.language.projects import Project
from lumen.loading.files import read_files
from lumen.ports import Message
from lumen.runtime.watcher import QUIET, Saved, Watcher

MODES = ("auto", "manual", "off")
"""Take saved files at once; only judge them, and wait for `lumen reload --apply`; leave them alone."""

_log = logging.getLogger(__name__)


@dataclass
class Staged:
    """A good bundle on its way: `going` is whether it is to be put in force, `since` when that was asked [s].

    `asked` is the snapshot from which it could not go on; `told` what it was said to wait for.
    """

    project: Project
    changes: tuple[Change, ...]
    judged: Judged | None = None
    who: str = "files"
    going: bool = False
    now: bool = False
    back: bool = False
    since: float = field(default_factory=time.monotonic)
    asked: object = None
    told: str = ""
    orders: list[Order] = field(default_factory=list)


class Reloading:
    """Stages every good bundle and applies it at the first tick at which the running state allows it.

    What comes of it goes to the transcript, to the bus (`lumen.config.status`) and into the records. `apart` is
    whether files are judged in another process. `quiet` [s] and `budget` [s] are those of the watcher and of stories.
    """

    def __init__(
        self,
        show: Show,
        transcript: Transcript,
        *,
        mode: str = "auto",
        records: Records | None = None,
        applied: Callable[[Project], None] = lambda _: None,
        apart: bool = False,
        quiet: float = QUIET,
        budget: float = BUDGET,
    ) -> None:
        self._show, self._transcript, self._mode = show, transcript, mode
        self._records, self._applied = records or Records(None), applied
        self._bus = show.exhibition.bus
        self.revision = 0
        self.last: Bulletin | None = None
        self._staged: Staged | None = None
        self._came: deque[Message] = deque(maxlen=WAITING)
        project = show.exhibition.project
        self._court = (Jury if apart else Here)(Path(project.root))
        judge = Judge(self._court, lambda: self._running, budget)
        self._watcher: Watcher[Judged | list[Rehearsal]] = Watcher(
            Path(project.root),
            read_files(Path(project.root)),
            lambda saved: self._judge(judge, saved),
            hash=project.hash,
            quiet=quiet,
            hints=mode != "off",
            leisure=lambda judged, urgent: self._advise(judge, judged, urgent),
            noticed=self._court.begin,
        )
        self.probation = Probation(show, self._rolled_back)
        self._undo = self._bus.subscribe(COMMAND, self._came.append)
        self._watcher.start()

    @property
    def _running(self) -> Project:
        return self._show.exhibition.project

    def close(self) -> None:
        self._undo()
        self._watcher.close()
        self._court.close()

    def tick(self, now: float) -> None:
        """Take what was asked, see what the watcher found, and apply what is staged."""
        while self._came:
            self._hear(self._came.popleft())
        while not self._watcher.results.empty():
            found = self._watcher.results.get()
            if isinstance(found, Judged):
                self._take(found)
            else:
                self._warn(found)
        if self.probation.over(now):
            self._records.approve(self._running.hash)
        if self._staged and self._staged.going:
            self._go(self._staged, now)

    def _judge(self, judge: Judge, saved: Saved) -> Judged:
        """On the watcher's thread: routes that come with the files are made ready here, where nobody has to wait."""
        judged = judge(saved)
        if judged.good and judged.project:
            try:
                self._bus.prepare(by_key(judged.project))
            except BusError as error:
                return replace(judged, fault=f"the bus refuses its routes: {error}")
            self._records.store(saved.files)
        return judged

    def _advise(self, judge: Judge, judged: Judged | list[Rehearsal], urgent: Callable[[], bool]) -> None:
        """On the watcher's thread, when there is nothing more urgent."""
        if isinstance(judged, Judged) and (failed := judge.advise(judged, urgent)):
            self._watcher.results.put(failed)

    def _warn(self, failed: list[Rehearsal]) -> None:
        for rehearsal in failed:
            text = f"the story `{rehearsal.story.name}` does not hold with these files: {told(rehearsal)}"
            self._transcript.line("reload", text)

    def _hear(self, message: Message) -> None:
        try:
            order = order_from(message, self._bus)
        except UsageError as error:
            answering(message, self._bus)(self._answer("refused", str(error)).to_json())
            return
        if order.verb == "stop":
            self._show.exhibition.happen(Event("stop", {}))
            order.answer(self._answer("stopped", "the behaviour is told to stop").to_json())
        elif order.verb == "status":
            order.answer(self._status().to_json())
        elif self._mode == "off":
            order.answer(self._answer("refused", "it was started with --reload off").to_json())
        elif order.verb in ("reload", "dry-run"):
            self._watcher.ask(order)
        elif order.verb == "rollback" and (before := self.probation.before):
            back = live(self._running, before)
            self._stage(Staged(back, changes(self._running, back), who="command", back=True), order)
        elif order.verb == "apply" and self._staged:
            self._stage(self._staged, order)
        else:
            nothing = "to go back to" if order.verb == "rollback" else "staged"
            order.answer(self._answer("refused", f"there is nothing {nothing}").to_json())

    def _take(self, judged: Judged) -> None:
        """Decide on what was judged."""
        order = judged.saved.asked if isinstance(judged.saved.asked, Order) else None
        if not judged.good or judged.project is None:
            self._staged = None
            bulletin = self._verdict("refused", "command" if order else "files", judged)
            bulletin.reason = judged.fault
            self._tell(bulletin, [order] if order else [])
            return
        project = live(self._running, judged.project)
        found = changes(self._running, judged.project)
        staged = Staged(project, found, judged, "command" if order else "files")
        if order and order.verb == "dry-run" and judged.hash != self._running.hash:
            self._try(staged, order)
        elif judged.hash == self._running.hash:
            self._staged = None
            self._tell(self._verdict("unchanged", staged.who, judged), [order] if order else [])
        elif order or self._mode == "auto":
            self._stage(staged, order)
        else:
            self._staged = staged
            self._tell(self._about(staged, "staged"), [])

    def _stage(self, staged: Staged, order: Order | None) -> None:
        """Have a bundle put in force as soon as may be."""
        if self._staged and self._staged is not staged:
            staged.orders += self._staged.orders
        if order:
            staged.orders.append(order)
            staged.now |= order.now
        staged.going, staged.since, staged.asked, staged.told = True, time.monotonic(), None, ""
        self._staged = staged

    def _try(self, staged: Staged, order: Order) -> None:
        verdict = self._show.plan(staged.project, now=order.now)
        bulletin = self._about(staged, "dry run")
        match verdict:
            case Plan(notes=notes):
                bulletin.reason, bulletin.notes = "it would be in force at once", notes
            case Wait(reason, what):
                bulletin.reason = f"it would wait for `{what}`: {reason}"
            case Refusal():
                bulletin = refusal_of(verdict, staged.project, "command")
        order.answer({**bulletin.to_json(), "lines": list(bulletin.lines())})

    def _go(self, staged: Staged, now: float) -> None:
        """Apply it, wait for what it has to wait for, or refuse it."""
        expired = time.monotonic() - staged.since > self._running.patience
        snapshot = self._show.exhibition.runtime.snapshot
        if staged.asked is snapshot and not expired:
            return
        staged.asked = snapshot
        try:
            verdict = self._show.plan(staged.project, now=staged.now, back=staged.back)
            if isinstance(verdict, Plan):
                self._apply(staged, verdict, now)
                return
        except BusError as error:
            self._refuse(staged, f"the bus refuses its routes: {error}")
            return
        except Exception as error:  # a fault of ours costs the reload, and nothing else
            _log.exception("the saved files could not be put in force")
            self._refuse(staged, f"Lumen failed on these files: {error!r}")
            return
        if expired or not what_for(verdict):
            self._give_up(staged, verdict)
        elif verdict.reason != staged.told:
            staged.told = verdict.reason
            waiting = self._about(staged, "waiting")
            waiting.waiting_for, waiting.reason = what_for(verdict), verdict.reason
            self._tell(waiting, staged.orders)

    def _apply(self, staged: Staged, plan: Plan, now: float) -> None:
        before, began = self._running, time.perf_counter()
        self._show.apply(staged.project, plan)
        self._staged = None
        self.revision += 1
        self.probation.begin(before, now)
        bulletin = self._about(staged, "applied")
        bulletin.before, bulletin.revision, bulletin.notes = before.hash, self.revision, plan.notes
        bulletin.back = staged.back
        bulletin.took = {"applying": time.perf_counter() - began, "waiting": time.monotonic() - staged.since}
        self._tell(bulletin, staged.orders)
        self._applied(self._running)
        self._records.prune(self._running, self.probation.before, self.probation.good)

    def _give_up(self, staged: Staged, verdict: Wait | Refusal) -> None:
        """It has waited long enough, or can't go on from here at all."""
        staged.going = False
        if isinstance(verdict, Wait):
            waited = f"`{verdict.what}` is still under way after {self._running.patience:g} s ({verdict.reason})"
            self._refuse(staged, waited, "`lumen reload --now` does not wait", keep=True)
        else:
            self._staged = None
            self._tell(refusal_of(verdict, staged.project, staged.who), staged.orders)

    def _refuse(self, staged: Staged, reason: str, hint: str = "", *, keep: bool = False) -> None:
        self._staged = staged if keep else None
        bulletin = self._about(staged, "refused")
        bulletin.reason, bulletin.hint = reason, hint
        self._tell(bulletin, staged.orders)
        staged.orders = []

    def _rolled_back(self, reason: str, bad: Project) -> None:
        """The probation has brought back the bundle before."""
        self._staged = None
        self.revision += 1
        found = changes(bad, self._running)
        bulletin = Bulletin("rolled back", "probation", bad.hash, self._running.hash, self.revision, found)
        bulletin.reason = f"the new files failed: {reason}"
        self._tell(bulletin, [])

    def _about(self, staged: Staged, verdict: str) -> Bulletin:
        hashes = self._running.hash, staged.project.hash
        return Bulletin(verdict, staged.who, *hashes, self.revision, staged.changes, staged.judged)

    def _verdict(self, verdict: str, who: str, judged: Judged) -> Bulletin:
        return Bulletin(verdict, who, self._running.hash, judged.hash, self.revision, judged=judged)

    def _answer(self, verdict: str, reason: str) -> Bulletin:
        return Bulletin(verdict, "command", self._running.hash, self._running.hash, self.revision, reason=reason)

    def _status(self) -> Bulletin:
        staged, last = self._staged, self.last
        waiting = f", waiting: {staged.told}" if staged and staged.told else ", staged" if staged else ""
        bulletin = self._answer("status", f"revision {self.revision} runs ({self._mode}){waiting}")
        bulletin.more = {
            "mode": self._mode,
            "staged": [str(change) for change in staged.changes] if staged else None,
            "waiting": staged.told if staged else "",
            "probation": self.probation.left(self._show.exhibition.clock.now()),
            "last": last.to_json() if last else None,
            "lines": [bulletin.reason, *(last.lines() if last else [])],
        }
        return bulletin

    def _tell(self, bulletin: Bulletin, orders: list[Order]) -> None:
        """To the terminal, to the bus, to who asked, and into the journal."""
        lines, body = list(bulletin.lines()), bulletin.to_json()
        self.last = bulletin.kept()
        for line in lines:
            self._transcript.line("reload", line)
        self._records.write({"at": round(self._show.exhibition.clock.now(), 3), **body})
        told = {**body, "lines": lines}
        for order in orders:
            order.answer(told)
        try:
            self._bus.publish(STATUS, told)
        except BusError as error:
            _log.warning("what came of the saved files was not published: %s", error)
