"""The brain: the behaviour, among whoever else is there."""

from collections.abc import Callable, Iterator, Sequence

from lumen.app.causes import innermost
from lumen.app.live_behavior import LiveBehavior
from lumen.app.narrator import Narrator
from lumen.app.parts.part import Part
from lumen.language.commands import Rest
from lumen.language.events import Event
from lumen.language.projects import Project
from lumen.runtime.presence import BRAIN, Presence
from lumen.runtime.resuming import Resumption


class BrainPart(Part):
    """Runs the behaviour on a robot of this process.

    `recover` is asked at the beginning how to go on with the run before; it gives a text, empty or why not, where this
    one begins anew.
    """

    name = BRAIN

    def __init__(
        self, behavior: LiveBehavior, narrator: Narrator, presence: Presence | None = None, language: str = ""
    ) -> None:
        self.behavior, self._narrator, self._presence = behavior, narrator, presence
        self.recover: Callable[[], Resumption | str] = lambda: ""
        self._language, self._interrupted = language, False
        behavior.loop.observers.append(narrator)

    @property
    def project(self) -> Project:
        """The bundle that runs."""
        return self.behavior.project

    def begin(self, now: float) -> None:
        found = self.recover()
        if not isinstance(found, str):
            self._resume(found)
            return
        if found:
            self._narrator.note(found)
        self.behavior.start(self._language)

    def tick(self, now: float, changes: Sequence[Event]) -> None:
        for change in changes:
            self.behavior.loop.happen(change)
            self._narrator.line("others", f"{change.name}, after {change.data['seconds']:.1f} s")
        if self._presence and self._presence.came:
            self.behavior.trace.standing(self.behavior.loop.runtime.snapshot)
        self.behavior.loop.tick(now)

    def interrupt(self) -> bool:
        if self._interrupted:
            return False
        self._interrupted = True
        self.rest()
        self._narrator.line("operator", "Ctrl-C: the robot rests; again to end")
        return True

    def helpless(self, reason: str) -> None:
        self.rest()
        self._narrator.line("robot", f"rests, for nobody could stop it any more: {reason}")

    def rest(self) -> None:
        """Let the robot rest, and tell the behaviour to stop."""
        self.behavior.loop.robot.start("operator", Rest())
        self.behavior.loop.happen(Event("stop", {}))

    def summary(self) -> Iterator[str]:
        yield self._narrator.counted()

    def _resume(self, found: Resumption) -> None:
        """Go on where a run ended that nobody meant to end."""
        states = ", ".join(sorted(innermost(self.project.machine, found.snapshot.configuration)))
        self._narrator.note(
            f"The last run ended without notice {found.away:.0f} s ago: this one goes on from there, in {states}.\n"
            f"`lumen run --fresh` begins anew.{''.join(f' {note}.' for note in found.notes)}"
        )
        self.behavior.loop.resume(self._regained(found))

    def _regained(self, found: Resumption) -> Resumption:
        """What is left to go on with on this robot, which has forgotten what was under way."""
        return found
