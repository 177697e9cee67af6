"""The probation of a newly active bundle: if it fails in its first seconds, the last good bundle is restored."""

import logging
import time
from collections.abc import Callable, Sequence
from dataclasses import replace

from lumen.insight.changes import live
from lumen.insight.migration import MigrationPlan
from lumen.language.commands import Command
from lumen.language.projects import Project
from lumen.run.live_behavior import LiveBehavior
from lumen.run.resuming import anew

PERIOD = 10.0
"""The length of the probation on the exhibition's clock [s]."""

_log = logging.getLogger(__name__)


class RollbackGuard:
    """A watch over the bundle that was applied last.

    A failure is an exception from the interpreter or from performing a command, or a behaviour that does not come to
    rest. It restores `good`, the last bundle that passed its probation, by a migration plan; the failed event is then
    processed again. `back` is then called with the reason, the failed bundle and the duration [s]. The bundle of the
    start is on probation too, but has no earlier one in this run.
    """

    def __init__(self, behavior: LiveBehavior, back: Callable[[str, Project, float], None]) -> None:
        self._behavior, self._back = behavior, back
        self.good = _lean(behavior.loop.project)
        """The last bundle that passed its probation."""
        self.before: Project | None = None
        """The bundle before the last reload; None before the first."""
        self._until: float | None = behavior.loop.clock.now() + PERIOD
        behavior.loop.rescuers.append(self)

    def begin(self, before: Project, now: float) -> None:
        """Start the probation of another bundle at `now` [s]."""
        self.before, self._until = _lean(before), now + PERIOD

    def over(self, now: float) -> bool:
        """Return whether the bundle passes its probation at this call; it is then `good`."""
        if self._until is None or now < self._until:
            return False
        self._until, self.good = None, _lean(self._behavior.loop.project)
        return True

    def left(self, now: float) -> float | None:
        """Return the remaining time of the probation [s]; None if there is no probation."""
        return None if self._until is None else max(0.0, round(self._until - now, 3))

    def rescue(self, error: Exception) -> Sequence[Command] | None:
        """Restore the good bundle if the failed bundle is on probation.

        Return the commands of the change; None without a probation, or if the failed bundle is the good one.
        """
        bad = self._behavior.loop.project
        if self._until is None or self.good.hash == bad.hash:
            return None
        self._until, began = None, time.perf_counter()
        good = live(bad, self.good)
        _log.debug("a reload failed", exc_info=error)
        plan = self._plan(good)
        self._behavior.switch(good, plan, "rollback")
        self.before = _lean(bad)
        self._back(str(error) or repr(error), bad, time.perf_counter() - began)
        return plan.commands

    def _plan(self, good: Project) -> MigrationPlan:
        plan = self._behavior.plan(good, now=True, back=True)
        if isinstance(plan, MigrationPlan):
            return plan
        exhibition = self._behavior.loop
        return anew(good, exhibition.runtime.snapshot, exhibition.clock.now())


def _lean(project: Project) -> Project:
    """Return a bundle to go back to, without the places of nodes in its files, which take most of its memory."""
    return replace(project, documents={})
