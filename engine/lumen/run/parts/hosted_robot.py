"""A robot that is hosted on the bus, for the first brain that comes."""

import time
from collections.abc import Callable, Mapping, Sequence
from datetime import datetime
from pathlib import Path
from typing import Any

from lumen.bus.validated import ValidatedBus
from lumen.language.commands import Rest, Start
from lumen.language.events import Event
from lumen.language.people import PersonName
from lumen.language.projects import Project
from lumen.ports import Aim, Live, Perform, Record, RobotCommand
from lumen.project.home import home_of
from lumen.robot.deduplication_log import DEDUPLICATION_FILE
from lumen.robot.person_hold import StoppedBy
from lumen.robot.remote import RobotHost
from lumen.run.narrator import Narrator
from lumen.run.parts.foreign_commands import ForeignCommands, words
from lumen.run.parts.guard import BrainGuard
from lumen.run.parts.kept_hold import KeptHold, forget_hold
from lumen.run.parts.robot import RobotPart, RunBefore, Urgency
from lumen.run.presence import BRAIN, ROBOT_PART, Presence
from lumen.run.reload_journal import Journal
from lumen.run.setup import Setup
from lumen.upkeep.threads import WatchedThread


class HostedRobotPart(RobotPart):
    """A robot whose brain is in another process; if the brain is gone for BRAIN_TIMEOUT, the robot rests.

    `noticed` is called with each event that the robot notices, and each answer.
    """

    watches = False
    """False, because a brain in this process also reaches the robot over the bus."""

    def __init__(
        self,
        project: Project,
        bus: ValidatedBus,
        setup: Setup,
        presence: Presence,
        narrator: Narrator,
        noticed: Callable[[Event], None] = lambda _: None,
    ) -> None:
        # Commands, and with them questions to this part, arrive from the moment when the host listens.
        self._narrator, self._others, self._setup = narrator, presence, setup
        self._guard: BrainGuard | None = None
        self._interrupted = False
        self._noticed = noticed
        self._journal = Journal(None)
        self._home = home_of(Path(project.root), project.one_of_several)
        kept = KeptHold(self._home)
        listeners = (_CommandsOfOthers(narrator, self), Urgency(setup), kept)
        self._host = RobotHost(project, setup.robot, bus, setup.hall, listeners)
        before = RunBefore(kept, self._home / DEDUPLICATION_FILE)
        super().__init__(project, bus, setup, (), presence, server=self._host.server, before=before)

    @property
    def follows(self) -> str:
        """The session of the brain that the robot obeys; empty if there is none."""
        return self._guard.follows if self._guard else ""

    def stopped(self) -> bool:
        """Return whether a person stopped the robot."""
        return self.server.hold.stopped is not None

    @property
    def said(self) -> dict[str, str]:
        """The fields of the robot's presence: the brain that the robot obeys, who stopped the robot, and when."""
        stopped = self.server.hold.stopped
        held = {"stopped_by": stopped.by, "stopped_at": stopped.since.isoformat()} if stopped else {}
        return {"follows": self.follows, **held}

    def forget(self, person: PersonName) -> None:
        """Remove a person from the journal, on another thread so that no tick waits for that."""
        WatchedThread("lumen-forgetting", lambda: self._journal.forget(person)).start()

    def begin(self, now: float) -> None:
        self._journal = Journal(self._home)
        super().begin(now)
        self._guard = BrainGuard(self.robot, self._others, self._host.notice, self._say, time.monotonic)

    def tick(self, now: float, changes: Sequence[Event]) -> None:
        self._look(now)
        self._follow(now)
        for event in self._host.tick(now):
            self._noticed(event)
            kind, separator, _ = event.name.partition(".command.")
            if BRAIN not in self._others.parts and (kind == "error" or not separator):
                self._narrator.answered(event)

    def quiet_until(self, now: float) -> float:
        return now if self._host.waiting else super().quiet_until(now)

    def use(self, project: Project) -> None:
        self._host.use(project)
        if self.faces:
            self.faces.use(project)

    def interrupt(self) -> bool:
        if self._interrupted:
            return False
        self._interrupted = True
        self.server.hold.stop("Ctrl-C")
        self.robot.start("operator", Rest())
        self._say("rests: Ctrl-C; press it again to end")
        return True

    def helpless(self, reason: str) -> None:
        self.robot.start("guard", Rest())
        self._say(f"rests, because no person could stop it any more: {reason}")

    def close(self) -> None:
        if self._interrupted:
            forget_hold(self._home)
        try:
            self._host.close()
        finally:
            self.robot.close()

    def _follow(self, now: float) -> None:
        """Check the brain; send `stop` to a new one if a person has stopped the robot."""
        assert self._guard
        before = self.follows
        self._guard.tick(now)
        if self.follows != before and (stopped := self.server.hold.stopped):
            self._host.notice(Event("stop", {"by": stopped.by}, now))

    def record(self, entry: Mapping[str, Any]) -> None:
        """Write an entry of the journal of the robot's process."""
        self._journal.write(entry)

    def is_brains(self, id: str) -> bool:
        """Return whether a command of this id comes from the brain that the robot obeys."""
        session, _, own = id.partition(".")
        return bool(own) and session == self.follows

    def tell(self, command: RobotCommand, id: str) -> None:
        """Print a line for a command of the brain, unless a brain in this process has printed it."""
        if BRAIN in self._others.parts or isinstance(command, Aim | Live) or not self.is_brains(id):
            return
        if isinstance(command, Perform | Record):
            self._say(words(command))
        else:
            self._narrator.performing(Start("", command), self._setup.clock.now())

    def _say(self, text: str) -> None:
        self._narrator.line("robot", text)


class _CommandsOfOthers(ForeignCommands):
    """A listener that separates the commands of the followed brain from others."""

    def __init__(self, narrator: Narrator, part: HostedRobotPart) -> None:
        super().__init__(narrator, part.record)
        self._part = part

    def is_brains(self, id: str) -> bool:
        return self._part.is_brains(id)

    def given(self, command: RobotCommand, id: str) -> None:
        super().given(command, id)
        self._part.tell(command, id)


def stopped_there(presence: Presence) -> StoppedBy | None:
    """Return who stopped a robot in this process or another one, from its presence; None if it is not stopped."""
    peer = presence.find(ROBOT_PART)
    said = peer.said if peer else {}
    try:
        return StoppedBy(str(said["stopped_by"]), datetime.fromisoformat(said["stopped_at"]))
    except (KeyError, TypeError, ValueError):
        return None
