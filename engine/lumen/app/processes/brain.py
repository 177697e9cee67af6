"""The brain's process: the behaviour, its files and where it stands; the robot is on the bus."""

import json
from collections.abc import Sequence
from typing import Any

from lumen.app.causes import innermost
from lumen.app.modules.in_process import ModuleTroubles
from lumen.app.node import Node
from lumen.app.recovery.run_directory import RunDirectory
from lumen.app.reload.reloader import Reloader
from lumen.app.setup import Setup
from lumen.buses.validated import ValidatedBus
from lumen.cli.transcript import Transcript
from lumen.errors import BusRefusedError
from lumen.language.commands import Rest
from lumen.language.events import Event
from lumen.language.projects import Project
from lumen.language.stories import Story
from lumen.ports import Clock
from lumen.robots.remote import RemoteRobot
from lumen.runtime.delegated_tracking import DelegatedTracking
from lumen.runtime.presence import BRAIN, HERE, MOTION, ROBOT, Presence, told
from lumen.runtime.story import staged
from lumen.runtime.tracking import LocalTracking

SESSION = "brain.json"
"""Where a brain keeps under which session its commands travel, for the one that goes on after it."""
GONE = "the robot is gone"


class BrainPart:
    """Runs the behaviour on a robot that is somewhere else.

    A story says how it begins: at what time of day, in which language, remembering what. `mode` is how saved files are
    taken, `fresh` whether it begins anew where the last one ended without notice.
    """

    name = BRAIN
    needs: tuple[str, ...] = (ROBOT,)
    over = failed = False

    def __init__(
        self,
        project: Project,
        bus: ValidatedBus,
        url: str,
        clock: Clock,
        presence: Presence,
        run_directory: RunDirectory,
        transcript: Transcript,
        story: Story | None,
        *,
        mode: str,
        language: str,
        fresh: bool,
        speed: float,
    ) -> None:
        project = staged(project, story)
        self._bus, self._presence, self._run_directory, self._transcript = bus, presence, run_directory, transcript
        self._url, self._mode, self._language, self._fresh = url, mode, language, fresh
        self.robot = RemoteRobot(project, bus, clock.now, delegate=lambda id, command: self._tracking.play(id, command))
        own = LocalTracking(project, self.robot, bus)
        self._tracking = DelegatedTracking(own, project, bus, self._motion, self.robot.time)
        self.show = Node(project, Setup(self.robot, clock, None, remote=True, tracking=self._tracking), bus, story)
        self.show.using.append(self.robot.use)
        self.show.exhibition.patience *= speed  # whether it was away is a matter of real time, as for the robot
        self._session, self._lost, self._interrupted = "", False, False

    @property
    def project(self) -> Project:
        """The bundle that runs."""
        return self.show.exhibition.project

    def begin(self, now: float) -> None:
        show, records = self.show, self._run_directory.records
        show.exhibition.observers.append(self._transcript)
        troubles = ModuleTroubles(self.project, self._bus, self._transcript.line)
        show.exhibition.parts.append(troubles.tick)
        show.closing.insert(0, troubles.close)
        self._run_directory.open(show.bus, self._url, self.project)
        reloading = Reloader(
            show,
            self._transcript,
            mode=self._mode,
            records=records,
            applied=self._run_directory.announce,
            seen=self._run_directory.refused,
            apart=True,
        )
        show.exhibition.parts.append(reloading.tick)
        show.closing.insert(0, reloading.close)
        if records.keeper:
            show.after.append(lambda _: records.keep(show.exhibition))
        self._start(reloading)
        if self._run_directory.home:
            self._run_directory.home.write(SESSION, json.dumps({"session": self.robot.session}).encode())

    def tick(self, now: float, changes: Sequence[Event]) -> None:
        """Live through a tick. Raises BusError where the robot follows another brain."""
        if self._lost:
            self.robot.lose(GONE)
            self._lost = False
        self._look(changes)
        self.show.tick()

    def use(self, project: Project) -> None:
        """Its own reloading sees to that."""

    def interrupt(self) -> bool:
        if self._interrupted:
            return False
        self._interrupted = True
        self.robot.start("operator", Rest())
        self.show.exhibition.happen(Event("stop", {}))
        self._transcript.line("operator", "Ctrl-C: the robot rests; again to end")
        return True

    def summary(self) -> None:
        log = self._transcript
        print(f"  {len(log.states)} states, {log.said} texts, motions: {', '.join(log.played) or 'none'}")

    def close(self) -> None:
        self.show.close()

    def _start(self, reloading: Reloader) -> None:
        """Enter the initial states, or go on where a brain ended that nobody meant to end."""
        found = "" if self._fresh else self._run_directory.resumption(self.project)
        reloading.begin(self._run_directory.news)
        if isinstance(found, str):
            print(found, end="\n" * bool(found), flush=True)
            self.show.start(self._language)
            return
        states = ", ".join(sorted(innermost(self.project.machine, found.snapshot.configuration)))
        print(f"The last brain ended without notice {found.away:.0f} s ago: this one goes on from there, in {states}.")
        print(f"`--fresh` begins anew.{''.join(f' {note}.' for note in found.notes)}", flush=True)
        before = self._before()
        if before:
            self.robot.recover(before, found.lost)
            found = found._replace(lost=(), away=0.0)  # the robot itself says whether it was left alone for long
        self.show.exhibition.resume(found)

    def _before(self) -> str:
        """Under which session the last brain's commands travelled; empty where that is not known."""
        try:
            data: Any = json.loads((self._run_directory.home and self._run_directory.home.read(SESSION)) or b"")
            return str(data["session"])
        except (ValueError, TypeError, KeyError):
            return ""

    def _look(self, changes: Sequence[Event]) -> None:
        """See who came, who is lost, and whom the robot follows."""
        for change in changes:
            self.show.exhibition.happen(change)
            self._transcript.line("others", f"{change.name}, after {change.data['seconds']:.1f} s")
            self._lost |= change.name == "robot.lost"
        if self._presence.came:
            self.show.trace.standing(self.show.exhibition.runtime.snapshot)
        robot = self._presence.find(ROBOT)
        if robot is None:
            return
        if self._session and robot.session != self._session:
            self.robot.lose(GONE)
            self._tracking.restart()
        self._session = robot.session
        other = self._presence.get(str(robot.said.get("follows", "")))
        if other and self._presence.alive(other) and BRAIN in other.parts and other.state == HERE:
            raise BusRefusedError(f"the robot follows another brain by now, {told(other)}: this one ends")

    def _motion(self) -> str:
        """The motion module that has the files that run here."""
        if MOTION in self._presence.parts:
            return self._presence.session
        peer = self._presence.find(MOTION)
        return peer.session if peer and peer.said.get("bundle") == self.project.hash else ""
