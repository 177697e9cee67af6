"""The process of the motion module, Lumen Motion: it plays motions by name, and lets the head follow sightings."""

import logging
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from math import inf

from lumen.bus.validated import ValidatedBus
from lumen.language.commands import Track
from lumen.language.events import Event
from lumen.language.projects import Project
from lumen.ports import Clock, Message, Perform
from lumen.robot.remote import RemoteRobot
from lumen.run.delegated_tracking import motion_key
from lumen.run.narrator import Narrator
from lumen.run.parts.part import Part
from lumen.run.presence import BRAIN, MOTION, ROBOT_PART, Presence
from lumen.run.tracking import LocalTracking
from lumen.upkeep.threads import MessageGuard

WAITING = 1_000
"""The number of requests that may wait for a tick; one more drops the oldest."""

_log = logging.getLogger(__name__)


class MotionPart(Part):
    """The part that sends the robot the keyframes of the requested motions, and aims its head by the controllers.

    If the brain is gone, the controllers are switched off, and a brain that returns requests them again. If another
    process takes over the robot, the controllers restart.
    """

    name = MOTION
    needs = (ROBOT_PART,)

    def __init__(
        self, project: Project, bus: ValidatedBus, clock: Clock, presence: Presence, narrator: Narrator
    ) -> None:
        self._project, self._bus, self._presence, self._narrator = project, bus, presence, narrator
        self._robot = RemoteRobot(project, bus, clock.now)
        self._tracking = LocalTracking(project, self._robot, bus)
        self._asked: deque[Message] = deque(maxlen=WAITING)
        self._undo: Callable[[], None] = lambda: None
        self._guard = MessageGuard(_log, "the motion module")
        self._session, self._brain, self._played = "", "", 0

    def begin(self, now: float) -> None:
        self._undo = self._bus.subscribe(motion_key(self._project), self._asked.append)

    def tick(self, now: float, changes: Sequence[Event]) -> None:
        self._look()
        while self._asked:
            message = self._asked.popleft()
            with self._guard(message.key):
                self._do(message)
        self._robot.poll()
        if (time := self._robot.time()) is not None:
            self._tracking.tick(time)

    def quiet_until(self, now: float) -> float:
        return now if self._asked or self._tracking.on else inf

    def use(self, project: Project) -> None:
        before, self._project = self._project, project
        self._robot.use(project)
        self._tracking.reload(project)
        if motion_key(before) != motion_key(project):
            undo, self._undo = self._undo, self._bus.subscribe(motion_key(project), self._asked.append)
            undo()

    def summary(self) -> Iterator[str]:
        yield f"{self._played} motions sent"

    def close(self) -> None:
        self._undo()
        self._robot.close()

    def _look(self) -> None:
        robot, brain = self._presence.find(ROBOT_PART), self._presence.find(BRAIN)
        if robot and robot.session != self._session:
            on = self._tracking.on if self._session else ()
            self._session = robot.session
            for name in on:
                self._tracking.switch(Track(name, False))
                self._tracking.switch(Track(name))
        if BRAIN not in self._presence.parts and (brain is None or brain.session != self._brain):
            self._brain = brain.session if brain else ""
            if brain is None:
                for name in self._tracking.on:
                    self._tracking.switch(Track(name, False))

    def _do(self, message: Message) -> None:
        match message.body:
            case {"id": str(id), "play": str(name)} if name in self._project.motions:
                if message.body.get("bundle") != self._project.hash:
                    self._narrator.line("motion", f"does not play {name}: its files differ from the brain's")
                    return
                self._played += 1
                self._narrator.line("motion", f"plays {name}")
                self._robot.forward(id, Perform(self._project.motions[name]))
            case {"track": str(name), "on": bool(on)} if name in self._project.controllers:
                self._narrator.line("motion", f"{'follows what is seen with' if on else 'lets go of'} {name}")
                self._tracking.switch(Track(name, on))
            case _:
                self._narrator.line("trouble", f"unknown request: {str(message.body)[:80]}")
