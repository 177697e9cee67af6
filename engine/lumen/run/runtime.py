"""The core of a running behaviour, on one thread: events in, commands out, without waiting."""

import logging
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, NamedTuple, Protocol

from lumen.errors import LumenError
from lumen.insight.migration import MigrationVerdict, plan
from lumen.insight.replay.entries import How, JumpKind
from lumen.journal.forgotten_snapshots import forgetful
from lumen.language.causes import Cause
from lumen.language.commands import Command
from lumen.language.events import Event
from lumen.language.people import PersonName
from lumen.language.projects import Project
from lumen.run.approvals import Approvals
from lumen.run.best_alternative import best_alternative
from lumen.statechart import Snapshot, Step, elapse, initial, step

_log = logging.getLogger(__name__)


class Emission(NamedTuple):
    """Commands, and the number of the step that issued them."""

    step: int
    commands: Sequence[Command]


Rescue = Callable[[Exception], Sequence[Command] | None]
"""A function that is called after a failure to switch to another bundle.

It returns the commands of the switch, or None if it did not switch.
"""


class InputRecorder(Protocol):
    """A recorder of a behaviour's inputs, called before the commands of a step are performed; it must not block."""

    def stepped(self, step: Step, how: How) -> None:
        """Record a step."""

    def jumped(
        self, kind: JumpKind, project: Project, snapshot: Snapshot, commands: Sequence[Command] = (), **said: Any
    ) -> None:
        """Record that the behaviour continues from this snapshot of this project without a step."""


class Runtime:
    """A running behaviour: its bundle, its snapshot, and their changes at a tick.

    If a step fails, `rescue` may switch to another bundle, under which the event is processed again. Otherwise the
    event or timer is dropped and logged, and `dropped` is called with a sentence about it, because a message that makes
    a step fail must not end the exhibition. `observe` is called with every step, in order.
    """

    def __init__(
        self,
        project: Project,
        observe: Callable[[Step], None] = lambda _: None,
        rescue: Rescue = lambda _: None,
        dropped: Callable[[str], None] = lambda _: None,
    ) -> None:
        self.project = project
        self._observe, self._rescue, self._dropped = observe, rescue, dropped
        self._snapshot: Snapshot | None = None
        self.recorder: InputRecorder | None = None
        """Records what a replay of the steps needs; None for no journal."""
        self.approvals = Approvals()
        """Holds back events that a person must approve."""
        self.steps = 0
        """The number of steps so far; the first of a run is 1."""

    @property
    def begun(self) -> bool:
        """Whether the behaviour was started."""
        return self._snapshot is not None

    @property
    def snapshot(self) -> Snapshot:
        """The current snapshot. Raises RuntimeError before `start`."""
        if self._snapshot is None:
            raise RuntimeError("the runtime is not started: call `start` first")
        return self._snapshot

    def start(
        self,
        now: float = 0.0,
        *,
        language: str = "",
        epoch: float = 0.0,
        timezone: str = "",
        context: Mapping[str, Any] | None = None,
    ) -> list[Command]:
        """Enter the initial states; return the commands to perform.

        `context` overrides initial values. `language` is by default the project's first, `epoch` the date of time 0 [s
        since 1970], and `timezone` the IANA name for times of day.
        """
        language = language or self.project.languages[0]
        arguments: dict[str, Any] = {"at": now, "input": context, "language": language, "epoch": epoch}
        arguments["timezone"] = timezone
        return self._begin(initial(self.project.machine, **arguments), arguments)

    def tick(self, now: float, events: Iterable[Event] = ()) -> list[Command]:
        """Process timers and events up to `now` [s], in the order of their times; return the commands."""
        return [command for emission in self.advance(now, events) for command in emission.commands]

    def advance(self, now: float, events: Iterable[Event] = ()) -> list[Emission]:
        """Process timers and events as `tick` does; return the commands grouped by step.

        Steps without commands are omitted. A rescue's commands form their own group, with the number of the last step.
        """
        emitted: list[Emission] = []
        for event in sorted(events, key=lambda e: e.at):
            self._timers(min(event.at, now), emitted)
            self._hear(event, emitted)
        self._timers(now, emitted)
        return emitted

    def plan(self, project: Project, at: float, *, now: bool = False, back: bool = False) -> MigrationVerdict:
        """Return how the behaviour would continue under another bundle at `at` [s], or why it can't; nothing changes.

        `now` cancels the actions for which it would otherwise wait; `back` means that the bundle ran before.
        """
        return plan(self.project, project, self.snapshot, at=at, now=now, back=back)

    def apply(
        self, project: Project, planned: Snapshot, kind: JumpKind = "reload", commands: Sequence[Command] = ()
    ) -> None:
        """Switch to another bundle as planned, between two macrosteps; `commands` are those of the plan.

        After an internal error the old bundle continues, and the error is raised.
        """
        old, stood = self.project, self._snapshot
        self.project, self._snapshot = project, planned
        try:
            self.approvals.use(project.machine, planned)
            self._record(kind, commands)
        except Exception:
            self.project, self._snapshot = old, stood
            self.approvals.use(old.machine, stood)
            raise

    def note(self, **said: Any) -> None:
        """Record a text at this moment; the behaviour does not receive it."""
        self._record("keyframe", **said)

    def take(self, taken: Step) -> list[Command]:
        """Continue with a step that enters a state directly; return its commands."""
        return self._take(taken, "goto")

    def forget(self, person: PersonName) -> bool:
        """Remove a person's name from the snapshot, and journal that; return False if the name was not there."""
        before = self.snapshot
        self._snapshot = forgetful(self.project.machine, before, person)
        if self._snapshot is before:
            return False
        self._record("forget")
        return True

    def _begin(self, first: Step, arguments: Mapping[str, Any]) -> list[Command]:
        self._snapshot = first.snapshot
        self.approvals.use(self.project.machine)
        self.steps += 1
        self._record("start", first.commands, arguments=arguments)
        self._observe(first)
        return list(first.commands)

    def _take(self, taken: Step, how: How) -> list[Command]:
        self._snapshot = taken.snapshot
        self.steps += 1
        if self.recorder:
            self.recorder.stepped(taken, how)
        self._observe(taken)
        if self.approvals.waiting and (taken.exited or taken.invoked):
            self.approvals.look(self.project.machine, taken.snapshot)
        return list(taken.commands)

    def _record(self, kind: JumpKind, commands: Sequence[Command] = (), **said: Any) -> None:
        if self.recorder:
            self.recorder.jumped(kind, self.project, self.snapshot, commands, step=self.steps, **said)

    def _hear(self, event: Event, emitted: list[Emission]) -> None:
        try:
            event = best_alternative(self.project.machine, self.snapshot, event)
            waits = self.approvals.marked and self.approvals.holds(self.project.machine, self.snapshot, event)
            if not waits:
                self._emit(step(self.project.machine, self.snapshot, event), "heard", emitted)
        except Exception as error:
            rescued = self._rescue(error)
            if rescued is not None:
                emitted.append(Emission(self.steps, rescued))
                self._hear(event, emitted)
            else:
                _log.error("the event `%s` is dropped: %s", event.name, error, exc_info=_ours(error))
                self._record("dropped event", event=event.name)
                self._dropped(f"the event `{event.name}` is dropped: {error}")

    def _timers(self, until: float, emitted: list[Emission]) -> None:
        try:
            for taken in elapse(self.project.machine, lambda: self.snapshot, until):
                self._emit(_timed(taken), "timer", emitted)
        except Exception as error:
            rescued = self._rescue(error)
            if rescued is not None:
                emitted.append(Emission(self.steps, rescued))
                self._timers(until, emitted)
            else:
                self._drop_timer(error)

    def _emit(self, taken: Step, how: How, emitted: list[Emission]) -> None:
        if commands := self._take(taken, how):
            emitted.append(Emission(self.steps, commands))

    def _drop_timer(self, error: Exception) -> None:
        first = min(self.snapshot.timers, key=lambda t: t.due_ns)
        _log.error("the timer `%s` is dropped: %s", first.event, error, exc_info=_ours(error))
        kept = tuple(timer for timer in self.snapshot.timers if timer is not first)
        self._snapshot = self.snapshot._replace(timers=kept)
        self._record("dropped timer", event=first.event)
        self._dropped(f"the timer `{first.event}` is dropped: {error}")


def _timed(taken: Step) -> Step:
    """Return a timer's step with the timer as its cause, which the core does not set."""
    event = taken.event
    return taken._replace(event=event._replace(cause=Cause("timer", event.sendid))) if event else taken


def _ours(error: Exception) -> Exception | None:
    """Return an internal error, whose traceback is worth logging; None for a LumenError."""
    return None if isinstance(error, LumenError) else error
