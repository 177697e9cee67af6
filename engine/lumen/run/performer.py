"""The boundary between the behaviour and the world: it performs commands, and answers those that need no robot."""

import logging
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from lumen.errors import BusError
from lumen.language.causes import MessageOrigin
from lumen.language.commands import (
    Ask,
    BodyCommand,
    Cancel,
    Command,
    Do,
    GoTo,
    Language,
    Log,
    Play,
    PlaySound,
    Publish,
    Rest,
    Start,
    Stop,
    Tell,
    Track,
    Walk,
)
from lumen.language.events import Event
from lumen.language.projects import Project
from lumen.language.routes import DEFAULT_COMMAND_TTL
from lumen.language.routing_keys import TOLD, key_of_robot
from lumen.language.skills import lack_of, tracked, tracking_lack
from lumen.ports import Bus, Perform, Robot, RobotCommand
from lumen.project.sounds import sound_duration
from lumen.run.navigator import Navigator
from lumen.run.questions import Questions
from lumen.run.sending import send

LEFT_OUT = "left_out"
"""The field of an answer that names what the body lacks for a command that was left out."""

_log = logging.getLogger(__name__)


class Performer:
    """Performs commands on the robot and the bus.

    `track` switches a controller on or off. `refuse` returns why the robot may not begin a command; empty if it may.
    """

    def __init__(
        self,
        robot: Robot,
        bus: Bus,
        track: Callable[[Track], None],
        refuse: Callable[[RobotCommand], str] = lambda _: "",
        questions: Questions | None = None,
    ) -> None:
        self._robot, self._bus, self._track = robot, bus, track
        self.events: list[Event] = []
        """Answers for the next tick, to commands that end at once, need a part that is missing, or may not begin."""
        self.navigator = Navigator(robot, self._begin)
        """Splits walks to places into single walks."""
        self.questions = questions or Questions(bus)
        """Finds the answers to visitors' questions."""
        self.refuse = refuse

    def refusal(self, project: Project, command: Command) -> str:
        """Return why the robot may not begin a command; empty if it may, or if no robot performs it."""
        match command:
            case Start(_, Play(name)):
                return self.refuse(Perform(project.motions[name])) if name in project.motions else ""
            case Start(_, GoTo()):
                return self.refuse(Walk())
            case Start(_, wanted) if not isinstance(wanted, Play | Ask | Track | Language | GoTo):
                return "" if lack_of(wanted, project.body) else self.refuse(wanted)
        return ""

    def perform(self, project: Project, command: Command, now: float, step: int = 0) -> None:
        """Begin a command; messages that the command publishes name the step of this number as their cause."""
        match command:
            case Start(id, Ask() as asked):
                origin = MessageOrigin(cause=f"step {step}" if step else "")
                self.events += self.questions.ask(project, id, asked, now, origin)
            case Start(id, wanted):
                self._start(project, id, wanted, now)
            case Cancel(id):
                if not (self.navigator.cancel(id) or self.questions.cancel(id)):
                    self._robot.cancel(id)
            case Publish(name, body):
                if reason := send(self._bus, project, name, body, MessageOrigin(cause=f"step {step}" if step else "")):
                    self.events.append(Event("error.communication", {"route": name, "reason": reason}, now))
            case Tell(robot, event, data):
                self._tell(project, robot, event, data, MessageOrigin(cause=f"step {step}" if step else ""), now)
            case Log(text):
                _log.info(text)

    def _tell(self, project: Project, robot: str, event: str, data: object, origin: MessageOrigin, now: float) -> None:
        body = {"event": event, "data": {} if data is None else data, "from": project.robot}
        try:
            self._bus.publish(key_of_robot(TOLD, robot), body, ttl=DEFAULT_COMMAND_TTL, origin=origin)
        except BusError as error:
            self.events.append(Event("error.communication", {"to": robot, "reason": str(error)}, now))

    def _start(self, project: Project, id: str, wanted: BodyCommand, now: float) -> None:
        controller, body = project.controllers.get(tracked(wanted)), project.body
        if lack := tracking_lack(controller, body) if controller else lack_of(wanted, body):
            self.events.append(Event(f"done.command.{id}", {LEFT_OUT: lack.message}, now))
            return
        match wanted:
            case Play(name) if name in project.motions:
                self._begin(id, Perform(project.motions[name]), now)
            case Play(name):
                self._answer("error", id, now, f"there is no motion `{name}`")
            case PlaySound(file):
                self._sound(project, id, file, now)
            case Track():
                self._track(wanted)
                self._answer("done", id, now)
            case Language():
                self._answer("done", id, now)
            case GoTo(place):
                if reason := self.refuse(Walk()):
                    self._answer("error", id, now, reason)
                else:
                    self.navigator.start(id, place, now)
            case Do():
                self._begin(id, replace(wanted, sections=project.sections, row=project.verbs.get(wanted.skill)), now)
            case Ask():
                raise TypeError("a robot can't perform a question")
            case _:
                self._begin(id, wanted, now)

    def _sound(self, project: Project, id: str, file: str, now: float) -> None:
        """Begin a sound, with the duration of its file."""
        try:
            self._begin(id, PlaySound(file, sound_duration(Path(project.root), file)), now)
        except (OSError, ValueError) as error:
            self._answer("error", id, now, f"the sound {file} can't be played: {error}")

    def _begin(self, id: str, command: RobotCommand, now: float) -> None:
        if isinstance(command, Rest) or (isinstance(command, Stop) and command.what in ("all", "walk")):
            self.navigator.stop()
        if reason := self.refuse(command):
            self._answer("error", id, now, reason)
        else:
            self._robot.start(id, command)

    def _answer(self, kind: str, id: str, now: float, reason: str = "") -> None:
        self.events.append(Event(f"{kind}.command.{id}", {"reason": reason} if reason else None, now))
