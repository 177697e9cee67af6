"""The visitor: walks, speaks and touches in a simulated hall, by a story or by commands."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from math import inf
from typing import Any

from lumen.bus.validated import ValidatedBus
from lumen.language.commands import Command
from lumen.language.events import Event
from lumen.language.projects import Project
from lumen.language.stories import Story, VisitorAction
from lumen.ports import Bus, Hall
from lumen.robot.remote import RemoteHall
from lumen.run.entry_causes import innermost
from lumen.run.narrator import Narrator
from lumen.run.parts.part import Part
from lumen.run.presence import BRAIN, ROBOT_PART, VISITOR
from lumen.run.story import StoryEnvironment, StoryPlayer
from lumen.run.trace_subscriber import TraceSubscriber
from lumen.run.troubles import RunTrouble
from lumen.run.visitor import VisitorActor


class VisitorPart(Part):
    """A visitor in a hall of this process; `player` plays the story in `environment`, None without a story.

    `tell` is called with each action of the visitor in the story.
    """

    name = VISITOR

    def __init__(
        self,
        project: Project,
        bus: Bus,
        hall: Hall,
        environment: StoryEnvironment,
        story: Story | None,
        tell: Callable[[VisitorAction], None],
    ) -> None:
        self.actor, self.environment = VisitorActor(project, hall, bus), environment
        self.player = StoryPlayer(story, environment, self.actor, tell) if story else None

    @property
    def over(self) -> bool:
        return self.player is not None and self.player.finished

    @property
    def failed(self) -> bool:
        return self.player is not None and (bool(self.player.failure) or not self.player.finished)

    def tick(self, now: float, changes: Sequence[Event]) -> None:
        self.actor.tick(now)
        if self.player:
            self.player.tick(now)

    def quiet_until(self, now: float) -> float:
        if self.actor.walking:
            return now
        return self.player.quiet_until(now) if self.player else inf

    def use(self, project: Project) -> None:
        self.actor.use(project)


class RemoteVisitorPart(VisitorPart):
    """A visitor in a hall that is simulated in another process.

    With `telling` the transcript here shows what the robot does, because no brain in this process shows it.
    """

    needs = (ROBOT_PART, BRAIN)

    def __init__(
        self, project: Project, bus: ValidatedBus, narrator: Narrator, story: Story | None, *, telling: bool
    ) -> None:
        self._project, self._narrator, self._story = project, narrator, story
        self._hall = RemoteHall(project, bus)
        self._trace = TraceSubscriber(project, bus, self._hall.happen)
        super().__init__(project, bus, self._hall, self._trace, story, narrator.visitor_action)
        self._telling = telling
        if telling:
            self._trace.watchers.append(self)

    def begin(self, now: float) -> None:
        self.actor.tick(now)
        if self._story and self.player:
            self._narrator.note(f"The story is “{self._story.title}”.\n")
            self.player.start(now)
            self._trace.watchers.append(self.player)

    def tick(self, now: float, changes: Sequence[Event]) -> None:
        if self._telling:
            for change in changes:
                self._narrator.line("others", change.name)
        self._trace.tick(now)
        super().tick(now, changes)

    def use(self, project: Project) -> None:
        self._project = self._trace.project = project
        self._hall.use(project)
        super().use(project)

    def see(self, states: frozenset[str], entered: Sequence[str], context: Mapping[str, Any], place: str = "") -> None:
        """Print the states that were entered."""
        if inner := list(innermost(self._project.machine, frozenset(entered))):
            self._narrator.states.update(inner)
            self._narrator.line("state", ", ".join(inner))

    def performing(self, command: Command, now: float) -> None:
        self._narrator.performing(command, now)

    def answered(self, event: Event) -> None:
        self._narrator.answered(event)

    def troubled(self, trouble: RunTrouble) -> None:
        self._narrator.troubled(trouble)

    def summary(self) -> Iterator[str]:
        if self.player:
            early = "ended before the story was over" if not self.player.finished else "all well"
            yield f"the story: {self.player.failure or early}"
        if self._telling:
            yield self._narrator.counted()

    def close(self) -> None:
        self._trace.close()
        self._hall.close()
