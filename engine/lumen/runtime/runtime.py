"""The one thread's core: events in, commands out, and never a wait."""

from collections.abc import Callable, Iterable

from lumen.interpreters.statechart import Snapshot, Step, elapse, initial, step
from lumen.language.commands import Command
from lumen.language.events import Event
from lumen.language.projects import Project
from lumen.runtime.reload import Refusal, migrate


class Runtime:
    """A running behaviour: its bundle, its snapshot, and what happens to them at a tick.

    `observe` is shown every step in the order taken. `epoch` is the local time of day at time 0 [s since midnight].
    """

    def __init__(self, project: Project, observe: Callable[[Step], None] = lambda _: None) -> None:
        self.project = project
        self._observe = observe
        self._snapshot: Snapshot | None = None

    @property
    def snapshot(self) -> Snapshot:
        """Where the behaviour stands."""
        if self._snapshot is None:
            raise RuntimeError("start the runtime first")
        return self._snapshot

    def start(self, now: float = 0.0, *, language: str = "", epoch: float = 0.0) -> list[Command]:
        """Enter the initial states; the commands to perform."""
        language = language or self.project.languages[0]
        return self._take(initial(self.project.machine, at=now, language=language, epoch=epoch))

    def tick(self, now: float, events: Iterable[Event] = ()) -> list[Command]:
        """Let everything happen that is due until `now` [s], timers and events in the order of their times."""
        commands: list[Command] = []
        for event in sorted(events, key=lambda e: e.at):
            commands += self._timers(min(event.at, now))
            commands += self._take(step(self.project.machine, self.snapshot, event))
        return commands + self._timers(now)

    def reload(self, project: Project) -> Refusal | None:
        """Go on with another bundle, between two macrosteps; None, or why it can't be and nothing has changed."""
        result = migrate(self.project.machine, project.machine, self.snapshot)
        if isinstance(result, Refusal):
            return result
        self.project, self._snapshot = project, result
        return None

    def _timers(self, until: float) -> list[Command]:
        commands: list[Command] = []
        for taken in elapse(self.project.machine, lambda: self.snapshot, until):
            commands += self._take(taken)
        return commands

    def _take(self, taken: Step) -> list[Command]:
        self._snapshot = taken.snapshot
        self._observe(taken)
        return list(taken.commands)
