"""The reloader of a running exhibition: it activates good saved files and reports bad ones."""

import logging
import time
from collections import deque
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, NamedTuple

from lumen.bus.validated import by_key
from lumen.errors import BusError, UsageError
from lumen.insight.changes import changes, live
from lumen.language.causes import Cause
from lumen.language.events import Event
from lumen.language.projects import Project
from lumen.language.replay_check import ReplayCheck
from lumen.motion.bounds import analyse
from lumen.ports import Message
from lumen.project.chosen_robot import as_robot
from lumen.project.files import read_files
from lumen.run.live_behavior import LiveBehavior
from lumen.run.narrator import Narrator
from lumen.run.rehearsal import Rehearsal
from lumen.run.reload.migration_queue import MigrationQueue, StagedBundle
from lumen.run.reload.notifier import ReloadNotifier
from lumen.run.reload.records import RunRecords
from lumen.run.reload.report import ReloadReport
from lumen.run.reload.requests import WAITING, ReloadRequest, answering, command_key, request_from
from lumen.run.reload.restoring import Restored, restore
from lumen.run.reload.validation_worker import FileJudge, ValidationWorker
from lumen.run.reload.validator import BUDGET, BundleValidator, Validation, fault_of, told
from lumen.run.status import LastReload
from lumen.run.watcher import QUIET_PERIOD, FileWatcher, SavedFiles

_log = logging.getLogger(__name__)

NEWER_ON_DISK = "the project's folder still has the newer files"
UNTIL_APPLIED = "nothing saved there is activated until a person applies it"

MODES = ("auto", "manual", "off")
"""The ways in which saved files are used.

`auto` activates them at once, `manual` only checks them, for `lumen reload --apply`, and `off` ignores them.
"""


@dataclass(frozen=True, slots=True)
class ReloadOptions:
    """The way in which saved files are used."""

    mode: str = "auto"
    """One of `MODES`."""
    quiet: float = QUIET_PERIOD
    """The time without a change after which files are read [s]."""
    budget: float = BUDGET
    """The time for playing the saved stories, all together [s]."""
    seen: str = ""
    """The hash of the files that the start refused; they are not checked until they change. Empty for none."""


AUTO = ReloadOptions()


class _RolledBack(NamedTuple):
    """A rollback before its report."""

    report: ReloadReport
    orders: list[ReloadRequest]
    restored: Restored
    """The result of writing the files back."""
    validation: Validation
    """The check of the files that are in the folder now."""


class Reloader:
    """Has saved files checked, stages every good bundle, and answers operators.

    `files` are the project's present files; without them they are read. `worker` checks files, by default in another
    process. `applied` is called with each bundle that becomes active, and `wake`, on any thread, when files have been
    checked.
    """

    def __init__(
        self,
        behavior: LiveBehavior,
        narrator: Narrator,
        options: ReloadOptions = AUTO,
        *,
        files: Mapping[str, bytes] | None = None,
        records: RunRecords | None = None,
        applied: Callable[[Project], None] = lambda _: None,
        wake: Callable[[], None] = lambda: None,
        worker: FileJudge | None = None,
    ) -> None:
        self._behavior, self._mode = behavior, options.mode
        self._records = records or RunRecords(None)
        self._notifier = ReloadNotifier(behavior, narrator, self._records)
        self._queue = MigrationQueue(behavior, self._notifier, self._records, applied, self._restore)
        self._wake, self._newer_on_disk = wake, ""
        self._bus = behavior.loop.bus
        self._received: deque[Message] = deque(maxlen=WAITING)
        project = behavior.loop.project
        self._worker = worker or ValidationWorker(Path(project.root))
        self._validator = BundleValidator(self._worker, lambda: self._running, options.budget)
        self._watcher: FileWatcher[Validation | list[Rehearsal] | _RolledBack] = FileWatcher(
            Path(project.root),
            read_files(Path(project.root), project.one_of_several) if files is None else files,
            self._judge,
            hash=options.seen or project.hash,
            quiet=options.quiet,
            robot=project.one_of_several,
            hints=options.mode != "off",
            leisure=self._advise,
            noticed=self._worker.begin,
            early=self._validator.warm,
            good=lambda judged: isinstance(judged, Validation) and judged.good,
            done=wake,
        )
        self._undo = self._bus.subscribe(command_key(behavior.project.robot), self._received.append)
        self._watcher.start()

    @property
    def last(self) -> ReloadReport | None:
        """The last report; None before the first."""
        return self._notifier.last

    @property
    def last_reload(self) -> LastReload | None:
        """The last report in short, for the status; None before the first."""
        if (last := self.last) is None:
            return None
        return LastReload(self._notifier.last_at, last.verdict, last.after, next(iter(last.lines()), ""))

    @property
    def _running(self) -> Project:
        return self._behavior.loop.project

    def begin(self, news: Iterable[ReloadReport]) -> None:
        """Start the probation of the running bundle, and send `news`, the reports on this start as a reload."""
        self._records.begin(self._running.hash)
        for report in news:
            self._notifier.tell(report)

    def close(self) -> None:
        """End the watcher and the worker."""
        self._undo()
        self._watcher.close()
        self._worker.close()

    def reload(self, now: float) -> ReloadReport:
        """Reload the files from disk while the caller waits, between two ticks; return the report."""
        files = read_files(Path(self._running.root), self._running.one_of_several)
        request = ReloadRequest("reload", now=False, answer=lambda _: None)
        began = time.monotonic()
        self._take(self._judge(SavedFiles(files, tuple(files), began, began, request)))
        self._queue.tick(now)
        assert self.last
        return self.last

    @property
    def mode(self) -> str:
        """The way in which saved files are used: one of `MODES`."""
        return self._mode

    @property
    def on_probation(self) -> bool:
        """Whether the running files have not passed their probation yet."""
        return self._queue.rollback_guard.left(self._behavior.loop.clock.now()) is not None

    def offer(self, files: Mapping[str, bytes], answer: Callable[[Any], None], *, dry: bool = False) -> None:
        """Reload files that are not in the project's folder, between two visits; `answer` is called with each verdict.

        With `dry` they are only checked, and nothing that runs or waits changes.
        """
        verb = "dry-run" if dry else "reload"
        self._watcher.give(
            as_robot(files, self._running.one_of_several),
            ReloadRequest(verb, now=False, answer=answer, between=True),
        )

    def write(self, change: Callable[[], Mapping[str, bytes]]) -> None:
        """Let `change` write the running files to the project's folder; it returns the files that are then there."""
        self._watcher.write(change)

    def tick(self, now: float) -> None:
        """Handle requests and the watcher's results, and apply the staged bundle.

        An internal error fails only the reload.
        """
        try:
            self._tick(now)
        except Exception:
            _log.exception("the saved files could not be used")
            self._queue.drop()

    def _tick(self, now: float) -> None:
        while self._received:
            self._hear(self._received.popleft())
        while not self._watcher.results.empty():
            found = self._watcher.results.get()
            if isinstance(found, Validation):
                self._take(found)
            elif isinstance(found, _RolledBack):
                self._tell_back(found)
            else:
                self._warn(found)
        self._queue.tick(now)

    def _judge(self, saved: SavedFiles) -> Validation:
        """Check saved files, prepare their routes and motions, and store good files.

        This runs on the watcher's thread so that no tick waits.
        """
        validation = Validation(saved, "")
        try:
            validation = self._validator(saved)
            if validation.good and validation.project:
                self._bus.prepare(by_key(validation.project))
                analyse(validation.project.motions.values(), validation.project.body)
                self._records.store(saved.files)
        except BusError as error:
            return replace(validation, fault=f"the bus refuses its routes: {error}")
        except Exception as error:
            return replace(validation, fault=fault_of(error))
        return validation

    def _restore(self, report: ReloadReport, orders: list[ReloadRequest]) -> None:
        """Write the running files back to the folder on the watcher's thread, and then let the rollback be reported."""
        root, robot = Path(self._running.root), self._running.one_of_several

        def change() -> Mapping[str, bytes]:
            restored = restore(root, self._records.files(report.after))
            files, now = read_files(root, robot), time.monotonic()
            judged = self._judge(SavedFiles(files, (), now, now))
            self._watcher.results.put(_RolledBack(report, orders, restored, judged))
            self._wake()
            return files

        self._watcher.write(change)

    def _tell_back(self, back: _RolledBack) -> None:
        """Report a rollback and the folder of the newer files; newer files still on disk then wait for a person."""
        report, restored = back.report, back.restored
        if restored.trouble:
            self._newer_on_disk = f"{NEWER_ON_DISK} ({restored.trouble})"
            report.notes += (f"{self._newer_on_disk}: {UNTIL_APPLIED}",)
        else:
            report.notes += tuple(restored.lines())
            report.validation = back.validation if back.validation.hash == report.after else None
        self._notifier.tell(report, back.orders)

    def _advise(self, validation: Validation | list[Rehearsal] | _RolledBack, urgent: Callable[[], bool]) -> None:
        """Play further stories on the watcher's thread while nothing is more urgent."""
        if isinstance(validation, Validation) and (failed := self._validator.advise(validation, urgent)):
            self._watcher.results.put(failed)

    def _warn(self, failed: list[Rehearsal]) -> None:
        for rehearsal in failed:
            self._notifier.line(f"the story `{rehearsal.story.name}` fails with these files: {told(rehearsal)}")

    def _hear(self, message: Message) -> None:
        try:
            order = request_from(message, self._bus)
        except UsageError as error:
            answering(message, self._bus)(self._answer("refused", str(error)).to_json())
            return
        queue = self._queue
        if order.verb in ("apply", "try", "reload"):
            self._newer_on_disk = ""
        if order.verb == "stop":
            self._behavior.loop.happen(Event("stop", {}, cause=Cause("person", sender=message.sender)))
            order.answer(self._answer("stopped", "the behaviour stops").to_json())
        elif order.verb == "status":
            order.answer(self._status().to_json())
        elif self._mode == "off":
            self._notifier.tell(self._answer("refused", "the exhibition was started with --reload off"), [order])
        elif order.verb in ("reload", "dry-run"):
            if self._running.section(ReplayCheck).mode:
                order.answer(self._answer("judging", "playing the recorded visits with the saved files").to_json())
            self._watcher.request(order)
        elif order.verb == "rollback" and (before := queue.rollback_guard.before):
            back = live(self._running, before)
            queue.stage(StagedBundle(back, changes(self._running, back), who="command", back=True), order)
        elif order.verb == "apply" and queue.staged:
            queue.stage(queue.staged, order)
        elif order.verb == "apply" and queue.on_trial:
            queue.keep(order)
        elif order.verb == "try" and queue.staged:
            queue.attempt(queue.staged, order)
        elif order.verb == "refuse" and queue.staged:
            queue.refuse(queue.staged, order)
        else:
            nothing = "to go back to" if order.verb == "rollback" else "staged"
            self._notifier.tell(self._answer("refused", f"there is nothing {nothing}"), [order])

    def _take(self, validation: Validation) -> None:
        """Refuse, hold or stage files that were checked."""
        order = validation.saved.asked if isinstance(validation.saved.asked, ReloadRequest) else None
        who, orders, queue = "command" if order else "files", [order] if order else [], self._queue
        if not validation.good or validation.project is None:
            report = self._verdict("refused", who, validation, validation.fault)
            if order and order.verb == "dry-run":
                order.answer({**report.to_json(), "lines": list(report.lines())})
                return
            queue.drop()
            self._notifier.tell(report, orders)
            return
        project = live(self._running, validation.project)
        same = validation.running is self._running
        staged = StagedBundle(project, validation.changes if same else changes(self._running, project), validation, who)
        if order and order.verb == "dry-run" and validation.hash != self._running.hash:
            queue.dry_run(staged, order)
        elif validation.hash == self._running.hash:
            queue.drop()
            self._notifier.tell(self._verdict("unchanged", who, validation), orders)
        elif validation.objects and (order or self._mode == "auto"):
            queue.object(staged, order)
        elif order or (self._mode == "auto" and not self._newer_on_disk):
            queue.stage(staged, order)
        else:
            queue.hold(staged)

    def _verdict(self, verdict: str, who: str, validation: Validation, reason: str = "") -> ReloadReport:
        hashes, revision = (self._running.hash, validation.hash), self._queue.revision
        report = ReloadReport(verdict, who, *hashes, revision, validation.changes, validation, reason=reason)
        return report.compared(validation.project) if validation.project else report

    def _answer(self, verdict: str, reason: str) -> ReloadReport:
        hash = self._running.hash
        return ReloadReport(verdict, "command", hash, hash, self._queue.revision, reason=reason)

    def _status(self) -> ReloadReport:
        staged, last = self._queue.staged, self.last
        waiting = f", waiting: {staged.told}" if staged and staged.told else ", staged" if staged else ""
        newer = f", {self._newer_on_disk}: {UNTIL_APPLIED}" if self._newer_on_disk else ""
        report = self._answer("status", f"revision {self._queue.revision} runs ({self._mode}){waiting}{newer}")
        report.more = {
            "mode": self._mode,
            "staged": [str(change) for change in staged.changes] if staged else None,
            "waiting": staged.told if staged else "",
            **({"trial": True} if self._queue.on_trial else {}),
            "probation": self._queue.rollback_guard.left(self._behavior.loop.clock.now()),
            "last": last.to_json() if last else None,
            "lines": [report.reason, *(last.lines() if last else [])],
        }
        return report
