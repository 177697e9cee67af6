"""Performs the commands of Reachy Mini as activities."""

from collections.abc import Callable, Mapping
from contextlib import suppress
from math import degrees, inf, radians
from threading import Event
from typing import assert_never

from lumen.errors import BadCommandError, RobotFailedError, RobotRefusedError
from lumen.features.reachy.daemon_api import DaemonApi
from lumen.features.reachy.following import possible
from lumen.features.reachy.link import Measured
from lumen.features.reachy.mover import Mover
from lumen.features.reachy.others import DaemonMoves
from lumen.features.reachy.pose import HEAD, distance
from lumen.features.reachy.reach import shortest, shortfall
from lumen.features.reachy.sounds import LoadedSound, RobotSounds
from lumen.features.reachy.steps import StepActivity, Steps
from lumen.language.commands import Leds, Look, Move, PlaySound, Posture, Rest, Say, Stop, Volume, Wake, Walk
from lumen.language.motions import MotionDefinition
from lumen.motion.trajectories import Trajectory
from lumen.ports import Aim, Live, NativeCommand, Perform, Record
from lumen.robot.command_table import parts_of
from lumen.robot.cues import CueNotifier, EventSink
from lumen.robot.joint_ways import APPROACH_TIME, LOOK_SPEED, begun_from, home_angles, way_duration

TOLERANCE, PLACE_TOLERANCE = radians(6), 0.006
"""The largest distance from its goal at which the head has arrived [rad], [m]; it sags by up to 4 degrees."""
LYING_TOLERANCE, LYING_PLACE_TOLERANCE = radians(2.5), 0.003
"""The largest distance from the posture ASLEEP at which the head lies [rad], [m]."""
GRACE = 1.5
"""The time that the head can take beyond its planned duration [s]."""
LEAST_WAY = 0.4
"""The minimum duration of a change of posture [s]."""
LOOK_PERIOD = 0.1
"""The period in which the daemon is polled for the end of a move [s]."""
ASLEEP = "Asleep"
"""The posture in which the robot rests."""
FOREIGN_PATIENCE = 8.0
"""The longest time for which `wake` waits for the end of another program's move [s]."""


class ReachySkills:
    """Begins activities. `measured` returns the last measurement of the joints; `notice` receives events."""

    def __init__(
        self,
        api: DaemonApi,
        mover: Mover,
        moves: DaemonMoves,
        sounds: RobotSounds,
        measured: Callable[[], Measured],
        notice: EventSink,
    ) -> None:
        self._api, self._mover, self._moves, self._sounds = api, mover, moves, sounds
        self._measured, self._notice = measured, notice
        self._body = mover.body

    def begin(self, command: NativeCommand) -> StepActivity:
        """Return the activity of a command. Raises RobotError if the robot can't perform it, or is not awake."""
        match command:
            case Rest():
                self._mover.awake = False  # even if the rest fails, nothing is sent any more
                return StepActivity(self._rest())
            case Wake():
                return StepActivity(self._wake())
            case Say(text, language):
                return StepActivity(self._play(lambda: self._sounds.speech(text, language)), self._hush)
            case PlaySound(file, length):
                return StepActivity(self._play(lambda: self._sounds.sound(file, length)), self._hush)
            case Volume(level):
                self._sounds.volume = level
                return StepActivity(_nothing())
            case Leds():
                raise RobotRefusedError(f"{self._body.name} has no lights")
            case Record():
                raise RobotRefusedError(f"{self._body.name} records nothing for Lumen: its microphones need WebRTC")
            case Walk() | Move():
                raise RobotRefusedError(f"{self._body.name} has neither legs nor wheels")
            case Stop() | Aim() | Live():
                raise BadCommandError(f"{type(command).__name__} has no duration")
        if not self._mover.awake:
            raise RobotRefusedError("the motors are off: `wake` first")
        match command:
            case Look(yaw, pitch):
                return StepActivity(self._look(self._body.roles.head_joints(yaw, pitch)))
            case Posture(name, speed):
                return StepActivity(self._go(self._body.postures[name], speed, LEAST_WAY, f"the posture {name}"))
            case Perform(motion):
                return self._perform(motion)
            case _:
                assert_never(command)

    def _look(self, turned: Mapping[str, float]) -> Steps:
        """Turn the head, and return its other joints to the posture Stand."""
        stand = self._body.postures["Stand"]
        target = {**{name: stand[name] for name in HEAD}, **turned}
        way = max(abs(angle - self._mover.goal[name]) for name, angle in turned.items())
        yield from self._go(target, 1.0, way / LOOK_SPEED, "where it should look")

    def _go(self, target: Mapping[str, float], speed: float, least: float, where: str) -> Steps:
        """Move the joints smoothly to `target` [rad, m], in at least `least` [s] at full speed.

        Raises RobotFailedError if the rods, or an obstacle, keep the head from `target`.
        """
        goal, start = self._mover.goal, dict(self._mover.goal)
        way = {name: angle - start[name] for name, angle in target.items()}
        takes = max(way_duration(way, self._body, least) / speed, 1e-3)
        begin = now = yield None
        while now < begin + takes:
            share = (now - begin) / takes
            goal.update({name: start[name] + far * share * share * (3 - 2 * share) for name, far in way.items()})
            now = yield None
        goal.update(target)
        while now < begin + takes + GRACE and not self._arrived():
            now = yield None
        self._check(where)

    def _arrived(self) -> bool:
        joints = self._measured().joints
        if not joints:
            return False
        angles, places = distance(joints, possible(self._mover.goal, self._body))
        return angles <= TOLERANCE and places <= PLACE_TOLERANCE

    def _check(self, where: str) -> None:
        """Raise RobotFailedError if the head has not arrived, or if the goal is beyond reach; correct such a goal."""
        near = possible(self._mover.goal, self._body)
        if short := shortest(self._mover.goal, near):
            self._mover.goal.update(near)
            raise RobotFailedError(f"the head does not reach {where}: {short}")
        if not self._arrived():
            angles, places = distance(self._measured().joints or near, near)
            raise RobotFailedError(
                f"the head did not reach {where}: it is {degrees(angles):.0f} degrees and {1000 * places:.0f} mm away; "
                "something holds it, or its motors are off"
            )

    def _perform(self, motion: MotionDefinition) -> StepActivity:
        goal = self._mover.goal
        motion = begun_from(motion, self._body, goal)
        parts = parts_of(Perform(motion), self._body)
        home = {n: a for n, a in home_angles(motion, self._body, parts).items() if n not in motion.tracks and n in goal}
        activity = StepActivity(self._motion(motion, home))
        activity.missed = shortfall(motion, self._body)
        return activity

    def _motion(self, motion: MotionDefinition, home: Mapping[str, float]) -> Steps:
        goal, start = self._mover.goal, dict(self._mover.goal)
        course, cues = Trajectory(motion, start), CueNotifier(motion, self._notice)
        takes = way_duration({name: angle - start[name] for name, angle in home.items()}, self._body, APPROACH_TIME)
        begin = now = yield None
        while True:
            at = min(now - begin, motion.duration)
            share = min((now - begin) / takes, 1.0)
            goal.update(course.sample(at))
            goal.update({n: start[n] + (a - start[n]) * share * share * (3 - 2 * share) for n, a in home.items()})
            cues.advance(at, now)
            if at >= motion.duration:
                return
            now = yield None

    def _wake(self) -> Steps:
        """Have the daemon wake the robot, then move to the posture Stand; send no targets during the daemon's move.

        Raises RobotRefusedError if another program's move has not ended after FOREIGN_PATIENCE.
        """
        self._mover.awake = False
        now = yield None
        until = now + FOREIGN_PATIENCE
        while self._moves.foreign:
            if now >= until:
                raise RobotRefusedError(
                    "another program moves the robot: its daemon plays a move that Lumen did not begin"
                )
            now = yield None
        mode = yield self._api.get("/api/motors/status")
        if mode.get("mode") != "enabled":
            yield self._api.post("/api/motors/set_mode/enabled")
        yield from self._daemon_move("wake_up")
        if joints := self._measured().joints:
            self._mover.stand(joints)
        self._mover.awake = True
        yield from self._go(self._body.postures["Stand"], 1.0, LEAST_WAY, "the posture Stand")

    def _rest(self) -> Steps:
        """Have the daemon put the robot to sleep; end when the head lies, or the move ends."""
        yield from self._daemon_move("goto_sleep", self._lies, stops_others=True)

    def _lies(self) -> bool:
        joints = self._measured().joints
        if not joints:
            return False
        angles, places = distance(joints, {**joints, **self._body.postures[ASLEEP], "body_yaw": joints["body_yaw"]})
        return angles <= LYING_TOLERANCE and places <= LYING_PLACE_TOLERANCE

    def _daemon_move(
        self, name: str, enough: Callable[[], bool] = lambda: False, *, stops_others: bool = False
    ) -> Steps:
        """Have the daemon play a move; wait until it ends, or `enough` returns True.

        A cancellation stops the move. Moves that Lumen began earlier are stopped first; with `stops_others`, those of
        other programs are stopped, too.
        """
        given_up = Event()

        def stop(move: str) -> None:
            with suppress(RobotFailedError):  # it has ended by itself
                self._api.request("POST", "/api/move/stop", {"uuid": move})

        def begin() -> str:
            for other in self._moves.now():  # the daemon would play both simultaneously
                if other in self._moves.ours or stops_others:
                    stop(other)
            move = str(self._api.request("POST", f"/api/move/play/{name}")["uuid"])
            self._moves.ours.add(move)
            if given_up.is_set():
                stop(move)
            return move

        move = ""
        try:
            move = yield self._api.later(begin)
            asked = -inf
            while not enough():
                now = yield None
                if now >= asked + LOOK_PERIOD:
                    asked = now
                    if move not in (yield self._api.later(self._moves.now)):
                        break
        except GeneratorExit:
            given_up.set()
            if move:
                self._api.later(lambda: stop(move))
            raise

    def _play(self, load: Callable[[], LoadedSound]) -> Steps:
        sound: LoadedSound = yield self._api.later(load)
        if sound.file:
            yield self._api.post("/api/media/play_sound", {"file": sound.file})
        begin = now = yield None
        while now < begin + sound.duration:
            now = yield None

    def _hush(self) -> None:
        self._api.post("/api/media/stop_sound")


def _nothing() -> Steps:
    """Return steps that end at the first tick."""
    yield from ()
