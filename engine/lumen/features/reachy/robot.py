"""Reachy Mini behind the `Robot` interface."""

import logging
import time
from collections.abc import Callable, Sequence
from pathlib import Path

from lumen.errors import RobotError, RobotLostError, RobotRefusedError
from lumen.features.reachy.daemon_api import DaemonAddress, DaemonApi
from lumen.features.reachy.link import ReachyLink
from lumen.features.reachy.mover import Mover
from lumen.features.reachy.others import DaemonMoves, Strays
from lumen.features.reachy.pose import lies, target_message
from lumen.features.reachy.skills import ReachySkills
from lumen.features.reachy.sounds import RobotSounds
from lumen.features.reachy.steps import StepActivity
from lumen.features.reachy.taking_over import take_over
from lumen.language.body_parts import VOICE, WHOLE_BODY, part_of
from lumen.language.commands import Rest, Say, Wake
from lumen.language.events import Event
from lumen.language.robots import Body
from lumen.ports import Aim, Joints, Live, NativeCommand, Reading, RobotCommand, Sense
from lumen.robot.command_bounds import CommandBounds
from lumen.robot.command_table import parts_of, row_of, speech_duration
from lumen.robot.executor import ExecutingRobot, Executor
from lumen.robot.life_layer import LifeLayer
from lumen.robot.skill_runner import SkillRunner

LONGEST_TICK = 0.1
"""The longest time between two ticks that counts for speeds [s]: it keeps joints from jumping after a pause."""
WAKE_AGAIN = "reachy wakes again"
"""The id of the command that wakes the robot after a reconnection; `robot.back` replaces its answer."""

_log = logging.getLogger(__name__)


class ReachyRobot(ExecutingRobot):
    """The Reachy Mini whose daemon is at `url`; `clock` returns the real time of its answers and events [s].

    `voice` is its row in `voices`, or `none`; sound files are in `root`. If the connection breaks, all commands fail
    and `robot.lost` is raised. After a reconnection, the robot is woken if it was awake, and `robot.back` is raised.
    While something else moves the robot, no targets are sent and commands that move it, except `wake`, are refused.
    This raises `robot.busy` at its beginning and `robot.free` at its end. The constructor raises RobotError if there
    is no robot, UsageError if `url` is not an address or there is no such voice.
    """

    def __init__(
        self,
        body: Body,
        url: str,
        clock: Callable[[], float],
        *,
        voice: str = "none",
        language: str = "en",
        root: Path = Path(),
    ) -> None:
        self.body, self._clock = body, clock
        self._api = DaemonApi(DaemonAddress(url))
        self._bounds, self._part = CommandBounds(body), part_of(body)
        self._mover, self._moves, self._strays = Mover(body), DaemonMoves(self._api), Strays()
        self._sounds = RobotSounds(self._api, voice, language, root)
        self._events: list[Event] = []
        self._link = ReachyLink(self._api.address, self._take_over)
        self._skills = ReachySkills(
            self._api, self._mover, self._moves, self._sounds, lambda: self._link.measured, self._events.append
        )
        self._runner = SkillRunner()
        self._executor = Executor(self._begin, lambda command: parts_of(command, body), self._runner.begin)
        self._life = LifeLayer(body)
        self._last, self._seen = clock(), 0.0
        self._yields = self._was_awake = False
        self._away = self._taken_at = 0.0
        try:
            self._link.open()
            self._find_awake()
        except RobotError:
            self._link.close()
            self._api.close()
            raise
        self._moves.start()

    def start(self, id: str, command: RobotCommand) -> None:
        if isinstance(command, Live):
            self._life.live(command)
        elif isinstance(command, Aim):
            if (aim := self._bounds.aim(command)) and self._mover.awake and not self._yields:
                self._life.led(aim.angles, self._clock())
                free = {name: angle for name, angle in aim.angles.items() if self._free(name)}
                self._mover.aim(free, aim.speed)
        else:
            if isinstance(command, Rest):
                self._was_awake = False
            self._executor.start(id, command)

    def poll(self) -> Sequence[Event]:
        now = self._clock()
        dt, self._last = min(now - self._last, LONGEST_TICK), now
        self._notice_link(now)
        self._notice_others(now)
        answers = [event for event in self._executor.advance(now) if not self._woke_again(event, now)]
        self._move(now, dt)
        events = [*self._events, *answers]
        self._events.clear()
        return events

    def read(self, sense: Sense) -> Reading | None:
        if sense is not Sense.JOINT or not self._link.measured.joints:
            return None
        joints, at = self._link.measured
        age = time.monotonic() - at
        names = tuple(self.body.joints)
        stiffness = (1.0 if self._mover.awake else 0.0,) * len(names)
        angles = tuple(joints.get(name, 0.0) for name in names)
        return Joints(self._clock() - age, names, angles, stiffness, life=self._life.offsets)

    def close(self) -> None:
        """Close all connections; the robot holds its last target."""
        self._runner.close()
        self._moves.close()
        self._link.close()
        self._api.close()

    def _take_over(self, again: bool) -> None:
        take_over(self._api, self.body)

    def _find_awake(self) -> None:
        """Record whether the robot is awake, with motors on and the head raised; continue from its present pose."""
        joints = self._link.measured.joints
        mode = self._api.request("GET", "/api/motors/status").get("mode")
        self._mover.awake = mode == "enabled" and not lies(joints)
        self._mover.stand(joints)

    def _begin(self, command: NativeCommand, now: float) -> StepActivity:
        if isinstance(command, Rest):
            self._mover.awake = False
            self._link.keep_still()
        if not self._link.up:
            raise RobotLostError("the connection to the robot is lost")
        if self._yields and row_of(command).moves and not isinstance(command, Wake):
            raise RobotRefusedError(self._other())
        command = self._bounds.fit(command)
        activity = self._skills.begin(command)
        parts = parts_of(command, self.body)
        self._mover.drop_aims([name for name, part in self._part.items() if part in parts])
        if isinstance(command, Say):
            self._life.say(command, speech_duration(command.text), now)
        return activity

    def _free(self, joint: str) -> bool:
        return not self._executor.owner(self._part.get(joint, ""))

    def _notice_link(self, now: float) -> None:
        """Fail all commands when the robot is lost; when it is back, wake it if it was awake."""
        for name, seconds, reason in self._link.changes():
            self._strays.forget()
            if name == "robot.lost":
                self._was_awake = self._mover.awake or self._was_awake
                self._mover.awake = False
                self._life.still()
                self._executor.fail(f"the connection to the robot is lost: {reason}")
                self._events.append(Event(name, {"seconds": round(seconds, 3)}, now))
                continue
            self._sounds.renew()
            self._away = seconds
            if self._was_awake:
                self._executor.start(WAKE_AGAIN, Wake())
            else:
                self._events.append(Event(name, {"seconds": round(seconds, 3)}, now))

    def _woke_again(self, event: Event, now: float) -> bool:
        """Return whether an event answers WAKE_AGAIN; if so, raise `robot.back` unless the robot is lost again."""
        if not event.name.endswith(f".command.{WAKE_AGAIN}"):
            return False
        if event.name.startswith("error"):
            _log.warning("the robot is back, and could not be woken: %s", event.data["reason"])
        if self._link.up:
            self._was_awake = False
            self._events.append(Event("robot.back", {"seconds": round(self._away, 3)}, now))
        return True

    def _notice_others(self, now: float) -> None:
        """Fail all commands when something else moves the robot; follow its pose, to continue from there."""
        joints, at = self._link.measured
        if joints and at != self._seen and self._mover.awake:
            self._seen = at
            self._strays.measured(joints, now)
        taken = self._mover.awake and (self._moves.foreign or self._strays.taken)
        if taken and not self._yields:
            _log.warning("%s; Lumen sends nothing until that has ended", self._other())
            self._taken_at = now
            self._events.append(Event("robot.busy", {"reason": self._other()}, now))
            self._executor.fail(self._other())
            self._life.still()
        if self._yields and not taken and self._mover.awake and joints:
            _log.warning("nothing else moves the robot any more: Lumen goes on")
        if self._yields and not taken:
            self._events.append(Event("robot.free", {"seconds": round(now - self._taken_at, 3)}, now))
        if joints and (taken or self._yields):
            self._mover.stand(joints)
        self._yields = taken

    def _other(self) -> str:
        app = f" (`{self._moves.app}`)" if self._moves.app else ""
        if self._moves.foreign:
            return f"another program moves the robot{app}: its daemon plays a move that Lumen did not begin"
        return f"something else moves the robot{app}: another program that sends targets, or a hand"

    def _move(self, now: float, dt: float) -> None:
        """Send the joints' next target, unless the robot rests, is lost, or is moved by something else."""
        if not (self._mover.awake and self._link.up) or self._yields:
            self._life.still()
            return
        if not self._executor.owner(VOICE):
            self._life.hush(now)
        for yaw in self._moves.sounds():
            self._life.heard_by_head(yaw, 0.0, now)
        free = {part for part in WHOLE_BODY if not self._executor.owner(part)}
        offsets = self._life.advance(now, dt, free, lambda _part: 1.0)
        if target := self._mover.target(offsets, dt):
            self._link.send(target_message(target))
            self._strays.sent(target, now)
