"""A brain whose robot is in another process, reached over the bus."""

from collections.abc import Callable, Sequence
from typing import Any

from lumen.bus.validated import ValidatedBus
from lumen.errors import BusRefusedError
from lumen.language.commands import Rest
from lumen.language.events import Event
from lumen.language.projects import Project
from lumen.language.stories import Story
from lumen.ports import Clock, RobotCommand
from lumen.project.home import Home
from lumen.robot.command_table import row_of
from lumen.robot.person_hold import StoppedBy, on_head
from lumen.robot.remote import RemoteRobot
from lumen.run.delegated_tracking import DelegatedTracking
from lumen.run.live_behavior import LiveBehavior
from lumen.run.loop import BRAIN_LOST_AFTER, Observer
from lumen.run.narrator import Narrator
from lumen.run.parts.brain import BrainPart
from lumen.run.presence import BRAIN, HERE, MOTION, ROBOT_PART, Presence, where_it_runs
from lumen.run.resuming import FreshStart, Resumption
from lumen.run.setup import Setup
from lumen.run.tracking import LocalTracking

SESSION = "brain.json"
"""The file with the sessions of a brain's commands, for a brain that resumes the run."""
GONE = "the connection to the robot is lost"


class RemoteBody:
    """A robot on the bus, with tracking by the motion module if there is one."""

    def __init__(self, project: Project, bus: ValidatedBus, clock: Clock, presence: Presence) -> None:
        self._presence = presence
        self._project: Callable[[], Project] = lambda: project
        self.robot = RemoteRobot(
            project,
            bus,
            clock.now,
            delegate=lambda id, command: self.tracking.play(id, command),
            session=presence.session,
        )
        own = LocalTracking(project, self.robot, bus)
        self.tracking = DelegatedTracking(own, project, bus, self.motion_module, self.robot.time)
        self._clock = clock

    def behavior(
        self,
        project: Project,
        bus: ValidatedBus,
        story: Story | None,
        speed: float,
        adopt: Callable[[Project], None],
        refuse: Callable[[RobotCommand], str] = lambda _: "",
    ) -> LiveBehavior:
        """Return the behaviour on this robot.

        The gap between ticks that raises `brain.lost` is multiplied by `speed`: it is the same in real time at every
        speed, because the robot's process counts in real time as well.
        """
        setup = Setup(self.robot, self._clock, None, tracking=self.tracking)
        patience = BRAIN_LOST_AFTER * speed
        found = LiveBehavior(project, setup, bus, story, adopt=adopt, refuse=refuse, patience=patience)
        self._project = lambda: found.project
        return found

    def motion_module(self) -> str:
        """Return the session of the motion module if it runs the same files, else an empty string."""
        if MOTION in self._presence.parts:
            return self._presence.session
        peer = self._presence.find(MOTION)
        return peer.session if peer and peer.said.get("bundle") == self._project().hash else ""


class RemoteHold(Observer):
    """Predicts whether a robot in another process refuses to move because a person stopped it.

    `stopped` returns the state that the robot's process publishes, which may be a second old. If in doubt, a command is
    sent, and the robot decides. A touch of the robot's head allows movement again.
    """

    def __init__(self, stopped: Callable[[], StoppedBy | None]) -> None:
        self._stopped, self._let = stopped, False

    def answered(self, event: Event) -> None:
        if on_head(event) or event.name in ("resume", "stop"):
            self._let = event.name != "stop"

    def refuse(self, command: RobotCommand) -> str:
        """Return why the robot will refuse this command; empty if it may accept it."""
        stopped = None if self._let or not row_of(command).moves else self._stopped()
        return stopped.reason if stopped else ""


class RemoteBrainPart(BrainPart):
    """The part that runs the behaviour on a robot in another process."""

    needs = (ROBOT_PART,)

    def __init__(
        self,
        behavior: LiveBehavior,
        body: RemoteBody,
        narrator: Narrator,
        presence: Presence,
        home: Home | None,
        language: str = "",
        recover: Callable[[], Resumption | FreshStart] = FreshStart,
    ) -> None:
        super().__init__(behavior, narrator, presence, language, recover=recover)
        self.robot, self._tracking, self._others, self._home = body.robot, body.tracking, presence, home
        self.motion_module = body.motion_module
        self._session, self._lost = "", False
        self._earlier: dict[str, str] = {}

    def begin(self, now: float) -> None:
        super().begin(now)
        if self._home:
            said = {"session": self.robot.session, "earlier": self._earlier}
            self._home.write_json(SESSION, said)

    def tick(self, now: float, changes: Sequence[Event]) -> None:
        """Run one tick. Raises BusRefusedError if the robot follows another brain."""
        if self._lost:
            self.robot.lose(GONE)
            self._lost = False
        self._lost = any(change.name == "robot.lost" for change in changes)
        self._follow()
        super().tick(now, changes)

    def rest(self, by: str) -> None:
        """Make the robot rest, which the robot reports to the behaviour; without a robot, raise `stop` here."""
        if self._others.find(ROBOT_PART) is None:
            self.behavior.loop.happen(Event("stop", {"by": by}))
        self.robot.start("operator", Rest(by))

    def close(self) -> None:
        self.robot.close()

    def _regained(self, found: Resumption) -> Resumption:
        """Request the robot's answers to unfinished commands; only those of unknown sessions stay lost."""
        self._earlier = self._sessions(found.lost)
        for id, session in self._earlier.items():
            self.robot.recover(session, [id])
        return found._replace(lost=tuple(id for id in found.lost if id not in self._earlier))

    def _sessions(self, ids: Sequence[str]) -> dict[str, str]:
        """Return the sessions under which these commands were sent: that of the last brain, or of an earlier one."""
        data: Any = self._home.read_json(SESSION) if self._home else None
        match data:
            case {"session": str(last), **more}:
                earlier = more.get("earlier")
                known = earlier if isinstance(earlier, dict) else {}
                return {id: str(known.get(id, last)) for id in ids}
        return {}

    def _follow(self) -> None:
        """If another process has taken over the robot, end the open commands and restart tracking.

        Raises BusRefusedError if the robot follows another brain.
        """
        robot = self._others.find(ROBOT_PART)
        if robot is None:
            return
        if self._session and robot.session != self._session:
            self.robot.lose(GONE)
            self._tracking.restart()
        self._session = robot.session
        other = self._others.get(str(robot.said.get("follows", "")))
        if other and self._others.alive(other) and BRAIN in other.parts and other.state == HERE:
            raise BusRefusedError(f"the robot now follows another brain, {where_it_runs(other)}: this one ends")
