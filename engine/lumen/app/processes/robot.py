"""The robot's process: its body, Lumen Server, and the hall around it where it is simulated."""

import time
from collections.abc import Sequence
from pathlib import Path

from lumen.app.processes.guard import Guard
from lumen.app.setup import Setup
from lumen.buses.validated import ValidatedBus
from lumen.cli.performance import told_count
from lumen.cli.transcript import Transcript
from lumen.language.commands import Rest, Start
from lumen.language.events import Event
from lumen.language.modules import EYES
from lumen.language.projects import Project
from lumen.ports import Aim, Perform, Record, RobotCommand
from lumen.robots.deduplication_log import DEDUPLICATION_FILE, DeduplicationLog
from lumen.robots.remote import RobotHost
from lumen.runtime.home import home_of
from lumen.runtime.perception import FaceDetector
from lumen.runtime.presence import BRAIN, ROBOT, Presence


class RobotPart:
    """Hosts a robot on the bus, for the brain that comes first."""

    name = ROBOT
    needs: tuple[str, ...] = ()
    over = failed = False

    def __init__(
        self, project: Project, bus: ValidatedBus, chosen: Setup, presence: Presence, transcript: Transcript
    ) -> None:
        self._project, self._bus, self._chosen, self._transcript = project, bus, chosen, transcript
        self._presence = presence
        self._host: RobotHost | None = None
        self._faces: FaceDetector | None = None
        self._guard: Guard | None = None
        self._interrupted = False

    @property
    def follows(self) -> str:
        """The session of the brain that it obeys."""
        return self._guard.follows if self._guard else ""

    def begin(self, now: float) -> None:
        chosen = self._chosen
        self._host = RobotHost(self._project, chosen.robot, self._bus, chosen.hall, self._given)
        self._host.server.recall(DeduplicationLog(home_of(Path(self._project.root)) / DEDUPLICATION_FILE))
        self._guard = Guard(chosen.robot, self._presence, self._host.notice, self._say, time.monotonic)
        if chosen.hall:
            self._faces = FaceDetector(self._project, chosen.hall, self._bus)

    def tick(self, now: float, changes: Sequence[Event]) -> None:
        assert self._host
        assert self._guard
        if self._faces:
            self._faces.quiet = self._presence.find(EYES) is not None
            self._faces.tick(now)
        self._guard.tick(now)
        for event in self._host.tick(now):
            kind, separator, _ = event.name.partition(".command.")
            if BRAIN not in self._presence.parts and (kind == "error" or not separator):
                self._transcript.answered(event)

    def use(self, project: Project) -> None:
        self._project = project
        if self._host:
            self._host.use(project)
        if self._faces:
            self._faces.use(project)

    def interrupt(self) -> bool:
        if self._interrupted:
            return False
        self._interrupted = True
        self._chosen.robot.start("operator", Rest())
        self._say("rests: Ctrl-C; again to end")
        return True

    def summary(self) -> None:
        if self._host:
            print("  published: " + ", ".join(map(told_count, self._host.server.counts.items())))

    def close(self) -> None:
        if self._host:
            self._host.close()
        self._chosen.robot.close()

    def _given(self, command: RobotCommand) -> None:
        """A line for each command that it is given, where no brain in this process has told of it."""
        if BRAIN in self._presence.parts:
            return
        match command:
            case Perform(motion):
                self._say(f"plays {motion.name}")
            case Record(name, duration):
                self._say(f"listens for {duration:g} s: {name}")
            case Aim():
                pass
            case _:
                self._transcript.performing(Start("", command), self._chosen.clock.now())

    def _say(self, text: str) -> None:
        self._transcript.line("robot", text)
