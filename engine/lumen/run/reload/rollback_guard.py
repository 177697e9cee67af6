"""The first seconds of a bundle: where it fails in them, the one before comes back."""

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
"""Of the exhibition's clock [s]."""

_log = logging.getLogger(__name__)


class RollbackGuard:
    """Watches over the bundle that was applied last.

    A failure is an exception out of the interpreter or of what performs its commands, or a behaviour that does not come
    to rest. It brings back `good`, the bundle that has stood its probation, by the plan from the new to the old one;
    the event that failed happens again under it. `before` is what ran before the last reload. `back` is told. The
    bundle of the start is on probation, too; there is none to go back to in this run.
    """

    def __init__(self, behavior: LiveBehavior, back: Callable[[str, Project, float], None]) -> None:
        self._behavior, self._back = behavior, back
        self.good = _lean(behavior.loop.project)
        self.before: Project | None = None
        self._until: float | None = behavior.loop.clock.now() + PERIOD
        behavior.loop.rescuers.append(self)

    def begin(self, before: Project, now: float) -> None:
        """Another bundle runs since `now` [s]."""
        self.before, self._until = _lean(before), now + PERIOD

    def over(self, now: float) -> bool:
        """Whether the bundle has stood it just now."""
        if self._until is None or now < self._until:
            return False
        self._until, self.good = None, _lean(self._behavior.loop.project)
        return True

    def left(self, now: float) -> float | None:
        """How long it still lasts [s], None where none is under way."""
        return None if self._until is None else max(0.0, round(self._until - now, 3))

    def rescue(self, error: Exception) -> Sequence[Command] | None:
        """Go back to the good bundle, if the one that failed is on probation."""
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
    """A bundle to go back to: without what stands where in its files, which is most of it."""
    return replace(project, documents={})
