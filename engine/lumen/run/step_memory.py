"""The steps of the last minutes, which answer questions about a running exhibition."""

from collections import deque
from collections.abc import Callable
from heapq import merge

from lumen.insight.explaining import RecordedStep
from lumen.language.people import PersonName
from lumen.language.projects import Project
from lumen.run.loop import Observer
from lumen.statechart import Snapshot, Step

MAX_STEPS = 4_000
"""The number of steps with changes that are kept: some hours of visits."""
MAX_IDLE = 2_000
"""The number of kept steps that changed only the time, as for faces in a conversation: a few minutes."""

NumberedStep = tuple[int, RecordedStep]


class StepMemory(Observer):
    """An observer that keeps steps with the snapshots before them.

    `project` and `standing` return the present bundle and snapshot. Nothing is computed or copied, because snapshots
    never change.
    """

    def __init__(self, project: Callable[[], Project], standing: Callable[[], Snapshot | None]) -> None:
        self._project, self._standing = project, standing
        self._last: Snapshot | None = None
        self._number = 0
        self._changes: deque[NumberedStep] = deque(maxlen=MAX_STEPS)
        self._idle: deque[NumberedStep] = deque(maxlen=MAX_IDLE)

    def look(self) -> None:
        """Record a jump if the present snapshot is not that of the last step, as after a reload."""
        now = self._standing()
        if now is not None and now is not self._last:
            before, self._last = self._last, now
            if before is not None:
                gone, come = before.configuration, now.configuration
                jump = Step(None, tuple(sorted(gone - come)), tuple(sorted(come - gone)), (), now)
                self._keep(RecordedStep(self._project().machine, before, jump, self._project()))

    def stepped(self, step: Step) -> None:
        project = self._project()
        self._keep(RecordedStep(project.machine, None if step.event is None else self._last, step, project))
        self._last = step.snapshot

    def forget(self, person: PersonName) -> None:
        """Forget all steps, because any of them may contain the name.

        The redacted journal can still answer questions about them.
        """
        self._changes.clear()
        self._idle.clear()

    def steps(self) -> list[RecordedStep]:
        """Return all kept steps, the oldest first."""
        return [step for _, step in merge(list(self._changes), list(self._idle), key=lambda row: row[0])]

    def _keep(self, one: RecordedStep) -> None:
        self._number += 1
        idle = not (one.step.transitions or one.step.commands or one.step.raised or one.step.invoked or one.is_reload)
        (self._idle if idle and one.before else self._changes).append((self._number, one))
