"""A robot that is hosted on the bus, for the brain that comes first."""

import time
from collections.abc import Sequence
from pathlib import Path

from lumen.app.narrator import Narrator
from lumen.app.parts.guard import BrainGuard
from lumen.app.parts.robot import RobotPart
from lumen.app.setup import Setup
from lumen.buses.validated import ValidatedBus
from lumen.language.commands import Rest, Start
from lumen.language.events import Event
from lumen.language.projects import Project
from lumen.ports import Aim, Perform, Record, RobotCommand
from lumen.robots.deduplication_log import DEDUPLICATION_FILE, DeduplicationLog
from lumen.robots.remote import RobotHost
from lumen.runtime.home import home_of
from lumen.runtime.presence import BRAIN, Presence


class HostedRobotPart(RobotPart):
    """A robot whose brain is in another process; it rests where that one is gone for long."""

    def __init__(
        self, project: Project, bus: ValidatedBus, setup: Setup, presence: Presence, narrator: Narrator
    ) -> None:
        self._host = RobotHost(project, setup.robot, bus, setup.hall, self._given)
        super().__init__(project, bus, setup, presence, server=self._host.server)
        self._narrator, self._others, self._setup = narrator, presence, setup
        self._root = Path(project.root)
        self._guard: BrainGuard | None = None
        self._interrupted = False

    @property
    def follows(self) -> str:
        """The session of the brain that it obeys."""
        return self._guard.follows if self._guard else ""

    def begin(self, now: float) -> None:
        self.server.recall(DeduplicationLog(home_of(self._root) / DEDUPLICATION_FILE))
        self._guard = BrainGuard(self.robot, self._others, self._host.notice, self._say, time.monotonic)

    def tick(self, now: float, changes: Sequence[Event]) -> None:
        assert self._guard
        self._look(now)
        self._guard.tick(now)
        for event in self._host.tick(now):
            kind, separator, _ = event.name.partition(".command.")
            if BRAIN not in self._others.parts and (kind == "error" or not separator):
                self._narrator.answered(event)

    def use(self, project: Project) -> None:
        self._host.use(project)
        if self.faces:
            self.faces.use(project)

    def interrupt(self) -> bool:
        if self._interrupted:
            return False
        self._interrupted = True
        self.robot.start("operator", Rest())
        self._say("rests: Ctrl-C; again to end")
        return True

    def helpless(self, reason: str) -> None:
        self.robot.start("guard", Rest())
        self._say(f"rests, for nobody could stop it any more: {reason}")

    def close(self) -> None:
        try:
            self._host.close()
        finally:
            self.robot.close()

    def _given(self, command: RobotCommand) -> None:
        """A line for each command that it is given, where no brain in this process has told of it."""
        if BRAIN in self._others.parts:
            return
        match command:
            case Perform(motion):
                self._say(f"plays {motion.name}")
            case Record(name, duration):
                self._say(f"listens for {duration:g} s: {name}")
            case Aim():
                pass
            case _:
                self._narrator.performing(Start("", command), self._setup.clock.now())

    def _say(self, text: str) -> None:
        self._narrator.line("robot", text)
