"""The visitor's process: scripted or typed, and what they see of the robot."""

from collections.abc import Mapping, Sequence
from typing import Any

from lumen.app.causes import innermost
from lumen.buses.validated import ValidatedBus
from lumen.cli.performance import FAREWELL
from lumen.cli.transcript import Transcript
from lumen.cli.typed import TypedSpeech
from lumen.language.commands import Command
from lumen.language.events import Event
from lumen.language.projects import Project
from lumen.language.stories import Arrive, Story, Visitor
from lumen.robots.remote import RemoteHall
from lumen.runtime.presence import BRAIN, ROBOT, VISITOR
from lumen.runtime.story import StoryPlayer
from lumen.runtime.trace_subscriber import TraceSubscriber
from lumen.runtime.visitor import VisitorActor


class VisitorPart:
    """Walks, speaks and touches in a hall that is simulated elsewhere, as a story says or as is typed.

    `telling` is whether what they see is told here, where no brain in this process does.
    """

    name = VISITOR
    needs: tuple[str, ...] = (ROBOT, BRAIN)

    def __init__(
        self, project: Project, bus: ValidatedBus, transcript: Transcript, story: Story | None, *, telling: bool = True
    ) -> None:
        self._project, self._transcript, self._story = project, transcript, story
        self._hall = RemoteHall(project, bus)
        self._walker = VisitorActor(project, self._hall, bus)
        self._onlooker = TraceSubscriber(project, bus, self._hall.happen)
        self._player: StoryPlayer | None = None
        self._typed: TypedSpeech | None = None
        self._now = 0.0
        if telling:
            self._onlooker.watchers.append(self)

    @property
    def over(self) -> bool:
        if self._player:
            return self._player.finished
        return self._typed is not None and self._typed.gone_for(self._now) > FAREWELL

    @property
    def failed(self) -> bool:
        return self._player is not None and (bool(self._player.failure) or not self._player.finished)

    def begin(self, now: float) -> None:
        self._walker.tick(now)
        if self._story:
            print(f"The story is “{self._story.title}”.\n", flush=True)
            tell = self._transcript.visitor_action
            self._player = StoryPlayer(self._story, self._onlooker, self._hall, self._walker, tell)
            self._player.start(now)
            self._onlooker.watchers.append(self._player)
            return
        print("You are the visitor: type what you say. Ctrl-D walks away, Ctrl-C ends.\n", flush=True)
        self._walker.arrive(Visitor())
        self._transcript.visitor_action(Arrive(Visitor()))
        self._typed = TypedSpeech(self._walker, self._transcript.visitor_action)

    def tick(self, now: float, changes: Sequence[Event]) -> None:
        self._now = now
        if self in self._onlooker.watchers:
            for change in changes:
                self._transcript.line("others", change.name)
        self._onlooker.tick(now)
        self._walker.tick(now)
        if self._player:
            self._player.tick(now)
        elif self._typed:
            self._typed.tick(now)

    def use(self, project: Project) -> None:
        self._project = self._onlooker.project = project
        self._hall.use(project)
        self._walker.use(project)

    def interrupt(self) -> bool:
        return False

    def see(self, states: frozenset[str], entered: Sequence[str], context: Mapping[str, Any]) -> None:
        if inner := list(innermost(self._project.machine, frozenset(entered))):
            self._transcript.states.update(inner)
            self._transcript.line("state", ", ".join(inner))

    def performing(self, command: Command, now: float) -> None:
        self._transcript.performing(command, now)

    def answered(self, event: Event) -> None:
        self._transcript.answered(event)

    def summary(self) -> None:
        log = self._transcript
        if self._player:
            early = "ended before the story did" if not self._player.finished else "all well"
            print(f"  the story: {self._player.failure or early}")
        if self in self._onlooker.watchers:
            print(f"  {len(log.states)} states, {log.said} texts, motions: {', '.join(log.played) or 'none'}")

    def close(self) -> None:
        self._onlooker.close()
        self._hall.close()
