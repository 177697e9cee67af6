"""An exhibition with everything around it: senses on the bus, a visitor in the hall, files that may change."""

from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import replace
from datetime import datetime
from pathlib import Path

from lumen.app.setup import Setup
from lumen.bus import connect
from lumen.buses.validated import ValidatedBus, validated
from lumen.interpreters.migration import MigrationPlan, MigrationVerdict
from lumen.language.commands import Command, Say, Start
from lumen.language.events import Event
from lumen.language.projects import Project
from lumen.language.stories import Story, VisitorAction
from lumen.ports import Sense
from lumen.robots.server import RobotServer
from lumen.runtime.loop import BehaviorLoop, Observer, TickHook
from lumen.runtime.perception import FaceDetector
from lumen.runtime.story import StoryPlayer, staged
from lumen.runtime.trace_publisher import TracePublisher
from lumen.runtime.visitor import VisitorActor

MORNING = "10:00"
"""The time of day at which a story begins that does not say."""


class Node(Observer):
    """Puts the parts together; `tick` until it is over, then `close`.

    With a story its visitor plays it (`player`); without one the visitor (`walker`) does what whoever holds the show
    makes them do. Both are None where the robot is in no world of ours. `tell` hears what the visitor does. Where
    `sensing` is off, only those senses are on the bus that the behaviour hears of as events, and nothing tells of the
    behaviour. What is in `after` lives at the end of each tick, when all that it asked for has been performed; `using`
    is told of another bundle. A robot that is `remote` has its server where it is; `bus` may be one that is open.
    """

    def __init__(
        self,
        project: Project,
        chosen: Setup,
        bus: str | ValidatedBus = "memory://",
        story: Story | None = None,
        tell: Callable[[VisitorAction], None] = lambda _: None,
        *,
        sensing: bool = True,
    ) -> None:
        project = staged(project, story)
        self.bus = validated(connect(bus), project) if isinstance(bus, str) else bus
        self.robot, self._story = chosen.robot, story
        self.exhibition = BehaviorLoop(project, chosen.robot, self.bus, chosen.clock, chosen.tracking)
        self._sensed: Callable[[Project], Project] = _all if sensing else _quiet
        self.server = None if chosen.remote else RobotServer(self._sensed(project), chosen.robot, self.bus)
        self.trace = TracePublisher(self.bus, lambda: self.exhibition.project, chosen.clock.now)
        self.using: list[Callable[[Project], None]] = []
        self.walker: VisitorActor | None = None
        self.faces: FaceDetector | None = None
        self.player: StoryPlayer | None = None
        self.closing: list[Callable[[], None]] = [chosen.robot.close]
        if isinstance(bus, str):
            self.closing.insert(0, self.bus.close)
        self.after: list[TickHook] = []
        self.exhibition.observers.append(self)
        if sensing:
            self.exhibition.observers.append(self.trace)
        if self.server:
            self.closing.insert(0, self.server.close)
            self.exhibition.parts.append(self._sense)
        if chosen.hall:
            self.walker = VisitorActor(project, chosen.hall, self.bus)
            self.faces = FaceDetector(project, chosen.hall, self.bus)
            self.exhibition.parts += [self.walker.tick, self.faces.tick]
            if story:
                self.player = StoryPlayer(story, self.exhibition, chosen.hall, self.walker, tell)
                self.exhibition.observers.append(self.player)
                self.exhibition.parts.append(self.player.tick)

    def start(self, language: str = "") -> None:
        """Enter the initial states; a story may say in which language, at what time of day, and remembering what."""
        story = self._story
        self.exhibition.start(
            language=language or (story.language if story else ""),
            epoch=time_of_day((story.clock or MORNING) if story else ""),
            context=story.context if story else None,
        )

    def tick(self) -> float:
        """Live through a tick; its time [s]."""
        now = self.exhibition.tick()
        for part in self.after:
            part(now)
        return now

    def plan(self, project: Project, *, now: bool = False, back: bool = False) -> MigrationVerdict:
        """How another bundle would go on from here, or why it can't; nothing changes."""
        return self.exhibition.plan(staged(project, self._story), now=now, back=back)

    def apply(self, project: Project, plan: MigrationPlan, begun: Callable[[], None] = lambda: None) -> None:
        """Go on with another bundle as planned for this moment; `begun` is called before what that asks for is done.

        Raises what `switch` raises.
        """
        old = self.exhibition.project
        self.switch(project, plan)
        begun()
        self.exhibition.perform(plan, old)

    def switch(self, project: Project, plan: MigrationPlan) -> None:
        """Go on with another bundle, and leave undone what that asks for.

        Raises BusError where the bus refuses its routes, and whatever a fault of ours raises; nothing has changed then.
        """
        old, new = self.exhibition.project, staged(project, self._story)
        try:
            self._use(new)
            self.exhibition.switch(new, plan)
        except Exception:
            self._use(old)
            raise

    def _use(self, project: Project) -> None:
        """Let everything around the behaviour go by this bundle from now on."""
        self.bus.use(project)
        if self.server:
            self.server.use(self._sensed(project))
        for part in (self.walker, self.faces):
            if part:
                part.use(project)
        for use in self.using:
            use(project)

    def close(self) -> None:
        """End what has threads, files or windows open, whatever one of them may raise."""
        with ExitStack() as stack:
            for close in reversed(self.closing):
                stack.callback(close)

    def performing(self, command: Command, now: float) -> None:
        match command:
            case Start(_, Say() as said) if self.server:
                self.server.begins(said)

    def answered(self, event: Event) -> None:
        if self.server:
            self.server.answer(event)

    def _sense(self, now: float) -> None:
        assert self.server
        self.server.sample(now)
        self.server.settle()


def _all(project: Project) -> Project:
    return project


def _quiet(project: Project) -> Project:
    """The project without the routes of senses that become no event."""
    routes = {name: route for name, route in project.routes.items() if name not in set(Sense) or route.event}
    return replace(project, routes=routes)


def film(show: Node, path: Path) -> None:
    """Write a film of a simulated robot's show. Raises RobotError where nothing can be drawn."""
    from lumen.robots.simulation import SimulatedRobot
    from lumen.robots.simulation.film import Film

    assert isinstance(show.robot, SimulatedRobot)
    camera = Film(path, show.robot)
    show.exhibition.parts.append(camera.tick)
    show.closing.insert(0, camera.close)


def time_of_day(clock: str = "") -> float:
    """`09:30`, or now on this machine's clock, in [s] since midnight."""
    if clock:
        hours, minutes = clock.split(":")
        return int(hours) * 3600.0 + int(minutes) * 60.0
    now = datetime.now()
    return now.hour * 3600.0 + now.minute * 60.0 + now.second
