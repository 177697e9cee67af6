"""The brain: the part that runs the behaviour."""

from collections.abc import Callable, Iterator, Sequence

from lumen.language.commands import Rest
from lumen.language.events import Event
from lumen.language.projects import Project
from lumen.robot.person_hold import PersonHold
from lumen.run.entry_causes import innermost
from lumen.run.live_behavior import LiveBehavior
from lumen.run.narrator import Narrator
from lumen.run.parts.part import Part
from lumen.run.presence import BRAIN, Presence
from lumen.run.resuming import FreshStart, Resumption

RUN_BEFORE, ENGINE = "the run before", "the engine"
"""Values of `by` for a rest that no person requested."""


class BrainPart(Part):
    """The part that runs the behaviour on a robot of this process.

    `recover` returns how the behaviour begins: where the previous run ended, or from the start. `hold` is the robot's
    hold by a person; None if the robot is elsewhere.
    """

    name = BRAIN

    def __init__(
        self,
        behavior: LiveBehavior,
        narrator: Narrator,
        presence: Presence | None = None,
        language: str = "",
        hold: PersonHold | None = None,
        recover: Callable[[], Resumption | FreshStart] = FreshStart,
    ) -> None:
        self.behavior, self._narrator, self._presence = behavior, narrator, presence
        self._recover = recover
        self._language, self._interrupted = language, False
        self._hold = hold

    @property
    def project(self) -> Project:
        """The bundle that runs."""
        return self.behavior.project

    def begin(self, now: float) -> None:
        found = self._recover()
        if isinstance(found, Resumption):
            self._resume(found)
            return
        if found.why:
            self._narrator.note(found.why)
        if found.rests and not (self._hold and self._hold.stopped):
            self.rest(RUN_BEFORE)
        self.behavior.start(self._language)

    def tick(self, now: float, changes: Sequence[Event]) -> None:
        for change in changes:
            self.behavior.loop.happen(change)
            self._narrator.line("others", f"{change.name}, after {change.data['seconds']:.1f} s")
        if self._presence and self._presence.came:
            self.behavior.trace.standing(self.behavior.loop.runtime.snapshot)
        self.behavior.loop.tick(now)

    def quiet_until(self, now: float) -> float:
        return self.behavior.loop.quiet_until(now)

    def leap(self, now: float) -> None:
        self.behavior.loop.leap(now)

    def interrupt(self) -> bool:
        if self._interrupted:
            return False
        self._interrupted = True
        self.rest("Ctrl-C")
        self._narrator.line("operator", "Ctrl-C: the robot rests; press it again to end")
        return True

    def helpless(self, reason: str) -> None:
        self.rest(ENGINE)
        self._narrator.line("robot", f"rests, because no person could stop it any more: {reason}")

    def rest(self, by: str) -> None:
        """Make the robot rest on behalf of `by`, and raise `stop` in the behaviour."""
        if self._hold:
            self._hold.stop(by)
        else:
            self.behavior.loop.happen(Event("stop", {"by": by}))
        self.behavior.loop.robot.start("operator", Rest(by))

    def summary(self) -> Iterator[str]:
        yield self._narrator.counted()

    def _resume(self, found: Resumption) -> None:
        """Continue where the previous run ended."""
        states = ", ".join(sorted(innermost(self.project.machine, found.snapshot.configuration)))
        self._narrator.note(
            f"The last run {'was ended' if found.told else 'ended unexpectedly'} {found.away:.0f} s ago: "
            f"this one continues from there, in {states}.\n"
            f"`lumen run --fresh` starts from the beginning.{''.join(f' {note}.' for note in found.notes)}"
        )
        self.behavior.loop.resume(self._regained(found))

    def _regained(self, found: Resumption) -> Resumption:
        """Return the part of a resumption that is possible on this robot, which has lost the unfinished commands."""
        return found
