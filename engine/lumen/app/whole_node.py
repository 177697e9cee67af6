"""All parts of an exhibition in one process: visitor, robot and brain."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from lumen.app.claiming import presence_of
from lumen.app.film_progress import FilmProgress
from lumen.app.live_behavior import LiveBehavior
from lumen.app.narrator import Narrator
from lumen.app.node import Node
from lumen.app.parts.brain import BrainPart
from lumen.app.parts.film import FilmPart
from lumen.app.parts.foreign_commands import ForeignCommands
from lumen.app.parts.module import ModulePart
from lumen.app.parts.module_troubles import ModuleTroublesPart
from lumen.app.parts.part import Part
from lumen.app.parts.robot import RobotPart
from lumen.app.parts.visitor import VisitorPart
from lumen.app.setup import Setup
from lumen.buses.validated import ValidatedBus
from lumen.errors import LumenError
from lumen.language.modules import EYES
from lumen.language.projects import Project
from lumen.language.stories import Story
from lumen.modules.audio_track import AudioTrack
from lumen.runtime.loop import BehaviorLoop
from lumen.runtime.presence import BRAIN, MOTION, ROBOT_PART
from lumen.runtime.resuming import FreshStart, Resumption
from lumen.runtime.story import StoryPlayer


class WholeNode(Node):
    """A project on a robot, a bus and a clock.

    With a story, its visitor plays it; without one the visitor does what whoever holds this makes them do. There is no
    `visitor` where the robot is in no world of ours. A `silent` one publishes nothing of the behaviour, and of the
    senses only what the behaviour hears of. On a `shared` bus others can see that it is there. `recover` decides how
    the behaviour begins; `record` keeps in the journal what the robot is told over the bus.
    """

    def __init__(
        self,
        project: Project,
        setup: Setup,
        bus: ValidatedBus,
        story: Story | None = None,
        narrator: Narrator | None = None,
        *,
        language: str = "",
        silent: bool = False,
        shared: bool = False,
        recover: Callable[[], Resumption | FreshStart] = FreshStart,
        record: Callable[[Mapping[str, Any]], None] = lambda _: None,
    ) -> None:
        self.behavior = LiveBehavior(project, setup, bus, story, published=not silent, adopt=self.use)
        self.narrator = narrator or Narrator(setup.clock.now, lambda: self.project.machine)
        here = tuple(name for name, said in project.modules.items() if said.here)
        roles = (ROBOT_PART, BRAIN, MOTION, *here)
        presence = presence_of(project, bus, roles, self._said) if shared else None
        super().__init__(self.behavior.project, bus, setup.clock, self.narrator, presence=presence)
        self.setup, self.story = setup, story
        self.robot = RobotPart(
            self.project, bus, setup, ForeignCommands(self.narrator, record=record), presence, silent=silent
        )
        self.loop.observers.append(self.robot)
        self.visitor: VisitorPart | None = None
        if setup.hall:
            act = self.narrator.visitor_action
            self.visitor = VisitorPart(self.project, bus, setup.hall, self.loop, story, act)
            self.parts.append(self.visitor)
        if self.player:
            self.loop.observers.append(self.player)
        hold = self.robot.server.hold
        self.brain = BrainPart(self.behavior, self.narrator, presence, language, hold, recover)
        self.parts += [self.robot, self.brain]
        self.paced = self.behavior.trace.pace

    def _said(self) -> dict[str, Any]:
        """What others hear of it besides that it is there."""
        return {"bundle": self.project.hash, "time": round(self.now, 3), "realtime": self.pace.realtime}

    @property
    def loop(self) -> BehaviorLoop:
        """The behaviour, as it runs."""
        return self.behavior.loop

    @property
    def player(self) -> StoryPlayer | None:
        """Who plays the story, if there is one."""
        return self.visitor.player if self.visitor else None

    def add(self, *parts: Part) -> None:
        """Let others take part, ticked before the brain."""
        where = self.parts.index(self.brain)
        self.parts[where:where] = parts

    def add_film(
        self,
        path: Path,
        track: AudioTrack | None = None,
        *,
        size: tuple[int, int] | None = None,
        progress: FilmProgress | None = None,
    ) -> None:
        """Write a film of a simulated robot, with what `track` hears. Raises RobotError where nothing can be drawn."""
        title = self.story.title if self.story else self.project.name
        film = FilmPart(path, self.setup.robot, track, size=size, title=title, progress=progress)
        self.loop.observers.append(film)
        self.narrator.of_visitor.append(film.visitor_action)
        self.add(film)

    def add_modules(self, folder: Path | None = None, *, awaited: bool = False) -> None:
        """Let the modules take part that `lumen.yaml` wants here; one that can't is told of, and the others begin.

        What they keep is in `folder`, None for nothing that lasts. Where they are `awaited`, each tick waits for the
        eyes: what they see does not depend on the machine.
        """
        tell, begun = self.narrator.line, list[ModulePart]()
        for name in (name for name, said in self.project.modules.items() if said.here):
            try:
                begun.append(ModulePart(name, self.project, self.bus, tell, folder, awaited=awaited))
            except LumenError as error:
                tell(name, str(error))
        names = [module.name for module in begun]
        if self.robot.faces and EYES in names:
            self.robot.faces.quiet = True
        if self.presence:
            self.presence.parts = (ROBOT_PART, BRAIN, MOTION, *names)
        self.add(*begun, ModuleTroublesPart(self.project, self.bus, tell, names))
