"""Accepted files until their activation, at the first tick at which the running state allows it."""

import logging
import time
from collections.abc import Callable
from dataclasses import dataclass, field

from lumen.errors import BusError
from lumen.insight.changes import Change, changes, live
from lumen.insight.migration import MigrationDelay, MigrationPlan, Refusal
from lumen.insight.replay.visits import waiting_state
from lumen.language.projects import Project
from lumen.run.live_behavior import LiveBehavior
from lumen.run.reload.notifier import ReloadNotifier
from lumen.run.reload.records import RunRecords
from lumen.run.reload.report import ReloadReport, reason_of, what_for
from lumen.run.reload.requests import ReloadRequest
from lumen.run.reload.rollback_guard import RollbackGuard
from lumen.run.reload.validator import Validation, fault_of
from lumen.statechart import Snapshot


class Trial:
    """A bundle that runs until the end of the present visit, or of the next one.

    A visit ends when the behaviour is back in the state in which it waits for a visitor.
    """

    def __init__(self, project: Project) -> None:
        self._home, self._away = waiting_state(project.machine), False

    def over(self, snapshot: Snapshot) -> bool:
        """Return whether the visit has ended; call this at each tick with the current snapshot."""
        home = self._home in snapshot.configuration
        self._away |= not home
        return home and self._away


OTHER_VISITS = "recorded visits would go differently with these files"
APPLY = "`lumen reload --apply` activates them anyway"
ONE_VISITOR = "for one visitor: after that visit, the previous files come back"
KEPT = "the files that were tried for one visitor stay active"
VISIT_OVER = "the visit for which these files were tried is over; `lumen reload --apply` activates them permanently"
BETWEEN = "a visit is under way"
BY_A_PERSON = "a person refused these files"

_log = logging.getLogger(__name__)


@dataclass
class StagedBundle:
    """An accepted bundle before its activation."""

    project: Project
    changes: tuple[Change, ...]
    """The changes from the bundle that runs."""
    validation: Validation | None = None
    """The result of the bundle's check; None for a bundle that ran before."""
    who: str = "files"
    """The origin of the request: `files`, `command` or `trial`."""
    going: bool = False
    """Whether the bundle will be activated as soon as possible."""
    now: bool = False
    """Whether to activate it without waiting for current actions."""
    back: bool = False
    """Whether the bundle ran before."""
    since: float = field(default_factory=time.monotonic)
    """When the activation was requested [s]."""
    asked: object = None
    """The last snapshot from which the bundle could not continue; None if there was none yet."""
    told: str = ""
    """The last reported reason for the delay."""
    objected: bool = False
    """Whether the bundle was refused because recorded visits would change."""
    trial: bool = False
    """Whether to activate the bundle for one visitor."""
    between: bool = False
    """Whether to wait for the end of a visit, without a time limit."""
    kept: "StagedBundle | None" = None
    """The bundle that waits again after this one's activation; None for none."""
    orders: list[ReloadRequest] = field(default_factory=list)
    """The requests that receive the bundle's verdicts."""


class MigrationQueue:
    """A queue of at most one bundle, `staged`, which `tick` activates, delays or refuses.

    `applied` is called with each newly active bundle; `restore` writes the files of a rollback to the project's folder
    and then reports the rollback.
    """

    def __init__(
        self,
        behavior: LiveBehavior,
        notifier: ReloadNotifier,
        records: RunRecords,
        applied: Callable[[Project], None],
        restore: Callable[[ReloadReport, list[ReloadRequest]], None],
    ) -> None:
        self._restore = restore
        self._behavior, self._notifier, self._records, self._applied = behavior, notifier, records, applied
        self.revision = 0
        """The number of bundles that became active."""
        self.staged: StagedBundle | None = None
        self._trial: Trial | None = None
        self._tried: StagedBundle | None = None
        self.rollback_guard = RollbackGuard(behavior, self._rolled_back)
        """Watches a newly active bundle."""

    @property
    def running(self) -> Project:
        """The bundle that runs."""
        return self._behavior.loop.project

    def stage(self, staged: StagedBundle, order: ReloadRequest | None = None) -> None:
        """Activate a bundle as soon as possible; it replaces the staged bundle, whose requests it takes over."""
        if self.staged and self.staged is not staged:
            staged.orders += self.staged.orders
        if order:
            staged.orders.append(order)
            staged.now |= order.now
            staged.between |= order.between
        staged.going, staged.since, staged.asked, staged.told = True, time.monotonic(), None, ""
        self.staged = staged

    def hold(self, staged: StagedBundle) -> None:
        """Keep a bundle until a person activates it, and report that it is staged."""
        self.staged = staged
        self._notifier.tell(self._about(staged, "staged"))

    def attempt(self, staged: StagedBundle, order: ReloadRequest) -> None:
        """Activate a bundle until a visit ends; afterwards the bundle is staged again."""
        staged.trial = True
        self.stage(staged, order)

    @property
    def on_trial(self) -> bool:
        """Whether the bundle that runs was activated for one visitor."""
        return self._trial is not None

    def keep(self, order: ReloadRequest) -> None:
        """End the trial for one visitor: the bundle that is tried stays active."""
        assert self._tried
        report = self._about(self._tried, "applied")
        report.reason = KEPT
        self._trial = self._tried = None
        self._notifier.tell(report, [order])

    def refuse(self, staged: StagedBundle, order: ReloadRequest) -> None:
        """Refuse a bundle on behalf of a person."""
        staged.orders.append(order)
        self._refuse(staged, BY_A_PERSON)

    def object(self, staged: StagedBundle, order: ReloadRequest | None) -> None:
        """Refuse a bundle that would change recorded visits, but keep it: a person may still activate it."""
        if self.staged:
            staged.orders += self.staged.orders
        staged.orders += [order] if order else []
        self._refuse(staged, OTHER_VISITS, APPLY, keep=True)
        staged.objected = True

    def drop(self) -> None:
        """Drop the staged bundle, because newer files are bad or the same as the running ones."""
        self.staged = None

    def dry_run(self, staged: StagedBundle, order: ReloadRequest) -> None:
        """Answer with the outcome that a reload of a bundle would have; nothing changes."""
        verdict = self._behavior.plan(staged.project, now=order.now)
        report = self._about(staged, "dry run")
        match verdict:
            case MigrationPlan(notes=notes):
                report.reason, report.notes = "they would be active at once", notes
            case MigrationDelay(reason, what):
                report.reason = f"they would wait for `{what}`: {reason}"
            case Refusal(hint=hint):
                report.verdict, report.reason = "refused", reason_of(verdict, staged.project)
                report.hint = hint
        if report.verdict != "refused" and staged.validation and staged.validation.objects:
            report.verdict, report.reason, report.hint = "refused", OTHER_VISITS, APPLY
        order.answer({**report.to_json(), "lines": list(report.lines())})

    def tick(self, now: float) -> None:
        """End a probation whose time has passed and a trial whose visit has ended.

        Then try to activate the staged bundle, unless it is only being held.
        """
        if self.rollback_guard.over(now):
            self._records.approve(self.running.hash)
        if self._trial and self._trial.over(self._behavior.loop.runtime.snapshot):
            self._end_trial()
        if self.staged and self.staged.going:
            self._go(self.staged, now)

    def _end_trial(self) -> None:
        """Stage the previous bundle after a trial's visit; the tried bundle waits again."""
        tried, before = self._tried, self.rollback_guard.before
        self._trial = None
        if before and not (self.staged and self.staged.going):
            back = live(self.running, before)
            found = changes(self.running, back)
            self.stage(StagedBundle(back, found, who="trial", now=True, back=True, kept=tried))

    def _go(self, staged: StagedBundle, now: float) -> None:
        """Apply a bundle, let it wait, or refuse it."""
        before, snapshot = self.running, self._behavior.loop.runtime.snapshot
        if staged.between and (home := waiting_state(before.machine)) and home not in snapshot.configuration:
            staged.since = time.monotonic()
            if staged.told != BETWEEN:
                staged.told = BETWEEN
                self._wait(staged, home, BETWEEN)
            return
        expired = time.monotonic() - staged.since > self.running.patience
        if staged.asked is snapshot and not expired:
            return
        staged.asked = snapshot
        try:
            verdict = self._behavior.plan(staged.project, now=staged.now, back=staged.back)
            if isinstance(verdict, MigrationPlan):
                self._apply(staged, verdict, now)
                return
        except Exception as error:  # an internal error fails only the reload
            why = f"the bus refuses its routes: {error}" if isinstance(error, BusError) else fault_of(error)
            if self.running is before:
                self._refuse(staged, why)
            self.staged = None
            return
        if expired or not what_for(verdict):
            self._give_up(staged, verdict)
        elif verdict.reason != staged.told:
            staged.told = verdict.reason
            self._wait(staged, what_for(verdict), verdict.reason)

    def _wait(self, staged: StagedBundle, what: str, why: str) -> None:
        waiting = self._about(staged, "waiting")
        waiting.waiting_for, waiting.reason = what, why
        self._notifier.tell(waiting, staged.orders)

    def _apply(self, staged: StagedBundle, plan: MigrationPlan, now: float) -> None:
        before, began = self.running, time.perf_counter()

        def begun() -> None:
            self.rollback_guard.begin(before, now)
            self.staged, staged.going = staged.kept, False
            self.revision += 1
            self._trial, self._tried = (Trial(self.running), staged) if staged.trial else (None, None)
            report = self._about(staged, "applied")
            report.reason = ONE_VISITOR if staged.trial else VISIT_OVER if staged.kept else ""
            staged.trial = False
            report.before, report.notes, report.back = before.hash, plan.notes, staged.back
            report.told_visits = bool(staged.told) or staged.objected
            report.took = {"applying": time.perf_counter() - began, "waiting": time.monotonic() - staged.since}
            self._tell_all(report, staged.orders)

        self._behavior.apply(staged.project, plan, begun)

    def _tell_all(self, report: ReloadReport, orders: list[ReloadRequest]) -> None:
        """Report a newly active bundle; an internal error in the report is logged and changes nothing."""
        try:
            if report.back and report.who == "command":
                self._restore(report, orders)
            else:
                self._notifier.tell(report, orders)
            if report.verdict == "applied":
                self._records.begin(self.running.hash)
            else:
                self._records.condemn()
            self._applied(self.running)
            self._records.prune(self.running, self.rollback_guard.before, self.rollback_guard.good)
        except Exception:
            _log.exception("the active files have changed, but not every process could be informed")

    def _give_up(self, staged: StagedBundle, verdict: MigrationDelay | Refusal) -> None:
        """Refuse a bundle that has waited too long, or can't continue from here."""
        staged.going = False
        if isinstance(verdict, MigrationDelay):
            waited = f"`{verdict.what}` is still under way after {self.running.patience:g} s ({verdict.reason})"
            self._refuse(staged, waited, "`lumen reload --now` does not wait", keep=True)
        else:
            self._refuse(staged, reason_of(verdict, staged.project), verdict.hint)

    def _refuse(self, staged: StagedBundle, reason: str, hint: str = "", *, keep: bool = False) -> None:
        self.staged = staged if keep else None
        report = self._about(staged, "refused")
        report.reason, report.hint = reason, hint
        report.took = {"waiting": time.monotonic() - staged.since}
        self._notifier.tell(report, staged.orders)
        staged.orders = []

    def _rolled_back(self, reason: str, bad: Project, took: float) -> None:
        """Report that the rollback guard restored the previous bundle, in `took` [s]."""
        self.staged = self._trial = self._tried = None
        self.revision += 1
        found = changes(bad, self.running)
        report = ReloadReport("rolled back", "probation", bad.hash, self.running.hash, self.revision, found)
        report.reason, report.took = f"the new files failed: {reason}", {"applying": took}
        self._tell_all(report, [])

    def _about(self, staged: StagedBundle, verdict: str) -> ReloadReport:
        hashes = self.running.hash, staged.project.hash
        report = ReloadReport(verdict, staged.who, *hashes, self.revision, staged.changes, staged.validation)
        return report.compared(staged.project)
