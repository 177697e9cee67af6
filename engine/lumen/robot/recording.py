"""A robot that records commands instead of moving, with realistic durations: for stories, tests and authors."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import hypot, inf
from typing import Any

from lumen.errors import RobotFailedError, RobotRefusedError, UsageError
from lumen.language.added_verbs import whole_result
from lumen.language.body_parts import LEGS, WHOLE_BODY, part_of
from lumen.language.causes import VISITOR, Cause
from lumen.language.commands import Do, Look, Move, Posture, Rest, Say, Wake, Walk
from lumen.language.diagnostics import did_you_mean
from lumen.language.events import Event
from lumen.language.robots import Body
from lumen.language.routes import BATTERY, JOINT, SONAR, TACTILE
from lumen.language.stories import Visitor
from lumen.motion.projection import Vector3, centring, seen
from lumen.motion.wayfinding import DeadReckoning, beyond
from lumen.ports import Aim, Battery, Joints, Live, Perform, Reading, Record, RobotCommand, Sense, Sonar, Tactile
from lumen.robot.command_bounds import CommandBounds
from lumen.robot.command_checks import added_verb
from lumen.robot.command_table import parts_of, row_of
from lumen.robot.cues import CueNotifier
from lumen.robot.executor import Activity, ExecutingRobot, Executor
from lumen.robot.life_layer import LifeLayer
from lumen.robot.silent_recording import SilentRecording
from lumen.robot.skill_runner import SkillRunner

TORSO_HEIGHT = 0.333
"""The height of a standing robot's torso above the floor [m]: that of NAO, because this robot has no model."""

PODIUM_HEIGHT = 0.5
"""The height of the podium under the robot [m]."""

FACE_HEIGHT_FRACTION = 0.93
"""The height of a visitor's face, as a fraction of their height."""


@dataclass
class _Lasting:
    """An activity that lasts until `until` [s], and ends at once if cancelled."""

    until: float

    def advance(self, now: float) -> bool:
        return now >= self.until

    def cancel(self) -> None:
        self.until = 0.0


@dataclass
class _Skill(_Lasting):
    """A verb of a feature; it ends with a result."""

    result: Mapping[str, Any]


class _Playing(_Lasting):
    """A motion; its words, sounds and skills become events at their times."""

    def __init__(self, until: float, begin: float, prompter: CueNotifier) -> None:
        super().__init__(until)
        self._begin, self._prompter = begin, prompter

    def advance(self, now: float) -> bool:
        over = super().advance(now)
        if not over or self.until:
            self._prompter.advance(now - self._begin, now)
        return over


class _Walking(_Lasting):
    """A walk at constant speed, which can end anywhere."""

    def __init__(self, until: float, begin: float, command: Walk | Move, reckoning: DeadReckoning) -> None:
        super().__init__(until)
        self._begin, self._reckoning, self._start = begin, reckoning, reckoning.whereabouts
        match command:
            case Walk(x, y, theta):
                self._way, self._takes, self._most = (x, y, theta), until - begin, 1.0
            case Move(vx, vy, vtheta):
                self._way, self._takes, self._most = (vx, vy, vtheta), 1.0, inf

    def advance(self, now: float) -> bool:
        part = min((now - self._begin) / self._takes, self._most) if self._takes else 1.0
        x, y, theta = (each * part for each in self._way)
        self._reckoning.follow(*beyond(self._start, x, y, theta))
        return super().advance(now)


class RecordingRobot(ExecutingRobot):
    """Gives commands realistic durations: its own for a motion, 0.4 s plus 0.06 s per character for a text.

    `behaves` maps a verb to `fails`, `hangs` or another duration [s], `results` an added verb to its result (else it is
    made of the defaults of its schema). After `rest` it refuses to move until `wake`, as other robots do. With a
    `runner` other added verbs are performed by their code. `performed` lists (time [s], command) in the order begun.
    Time passes only by `advance`. The head turns as commands demand, so that faces move in its camera.
    """

    def __init__(
        self,
        body: Body,
        behaves: Mapping[str, str | float] | None = None,
        results: Mapping[str, Mapping[str, Any]] | None = None,
        runner: SkillRunner | None = None,
    ) -> None:
        self.body = body
        self.performed: list[tuple[float, RobotCommand]] = []
        self.time = 0.0
        self._behaves, self._results = dict(behaves or {}), dict(results or {})
        self._angles = dict(body.postures["Stand"])
        self._pressed: set[str] = set()
        self._plugged, self._awake = False, True
        self._visitor: Visitor | None = None
        self._noticed: list[Event] = []
        self._reckoning = DeadReckoning()
        self._senses: Mapping[str, Callable[[], Reading | None]] = {
            JOINT: self._joints,
            SONAR: self._sonar,
            TACTILE: self._tactile,
            BATTERY: self._battery,
        }
        self._executor = Executor(self._begin, lambda command: parts_of(command, body), self._skill)
        self._runner = runner
        self.runs_no_skills = runner is None
        self._part = part_of(body)
        self._life = LifeLayer(body)
        self._bounds = CommandBounds(body)

    def start(self, id: str, command: RobotCommand) -> None:
        if isinstance(command, Live):
            self._life.live(command)
        elif isinstance(command, Aim):
            if aim := self._bounds.aim(command):
                self._life.led(aim.angles, self.time)
                self._angles.update({n: a for n, a in aim.angles.items() if self._free(n)})
        else:
            self._executor.start(id, command)

    def poll(self) -> Sequence[Event]:
        events, self._noticed = self._noticed, []
        return events

    @property
    def idle(self) -> bool:
        """True if no command is under way, no event is unread, and no visitor is in front of the robot."""
        return self._executor.idle and not (self._noticed or self._visitor)

    def advance(self, dt: float) -> None:
        """Advance the robot's time by `dt` [s]."""
        self.time += dt
        self._noticed += self._executor.advance(self.time)

    def read(self, sense: Sense) -> Reading | None:
        measure = self._senses.get(sense)
        return measure() if measure else None

    def _joints(self) -> Joints:
        names = tuple(self.body.joints)
        offsets = self._offsets()
        angles = tuple(self._angles.get(name, 0.0) + offsets.get(name, 0.0) for name in names)
        where = self._reckoning.whereabouts
        return Joints(self.time, names, angles, (1.0,) * len(names), position=where, life=offsets)

    def _sonar(self) -> Sonar | None:
        if self.body.sonar is None:
            return None
        distance = hypot(self._visitor.x, self._visitor.y) if self._visitor else 2.55
        return Sonar(self.time, distance, distance)

    def _tactile(self) -> Tactile | None:
        names = self.body.tactile
        return Tactile(self.time, names, tuple(int(name in self._pressed) for name in names)) if names else None

    def _battery(self) -> Battery:
        return Battery(self.time, 100, plugged=self._plugged, charging=False)

    def close(self) -> None:
        if self._runner:
            self._runner.close()

    def place(self, visitor: Visitor | None) -> None:
        self._visitor = visitor

    def face(self) -> tuple[float, float] | None:
        if self._visitor is None or self.body.camera is None:
            return None
        offsets, place = self._offsets(), _face_of(self._visitor)
        roles = self.body.roles
        now, more = roles.head_angles(self._angles), roles.head_angles(offsets)
        yaw, pitch = now[0] + more[0], now[1] + more[1]
        return seen(place, self.body.camera, yaw, pitch)

    def touch(self, sensor: str, pressed: bool) -> None:
        """Press or release a tactile sensor. Raises UsageError for one that the robot does not have."""
        if sensor not in self.body.tactile:
            raise UsageError(f"no sensor `{sensor}`: {did_you_mean(sensor, self.body.tactile, 'there are')}")
        if pressed != (sensor in self._pressed):
            self._pressed ^= {sensor}
            by = Cause("person", sender=VISITOR)
            self._noticed.append(Event("touched" if pressed else "released", {"sensor": sensor}, self.time, cause=by))

    def sound(self) -> None:
        if self._visitor and self.body.camera:
            yaw, pitch = centring(_face_of(self._visitor), self.body.camera)
            head = self.body.roles.head_angles(self._angles)
            self._life.heard(yaw - head[0], pitch - head[1], self.time)

    def set_skills(self, ends: Mapping[str, Mapping[str, Any] | str]) -> None:
        for name, end in ends.items():
            if isinstance(end, str):
                self._behaves[name] = end
            else:
                if isinstance(self._behaves.get(name), str):
                    del self._behaves[name]
                self._results[name] = end

    def plug(self, plugged: bool) -> None:
        self._plugged = plugged

    def _notice(self, event: Event) -> None:
        self._noticed.append(event)

    def _skill(self, command: Do, now: float) -> Activity:
        if self._runner is None or command.skill in self._behaves or command.skill in self._results:
            return self._begin(command, now)
        self.performed.append((now, command))
        return self._runner.begin(command, now)

    def _begin(self, command: RobotCommand, now: float) -> Activity:
        command = self._bounds.fit(command)
        if isinstance(command, Rest | Wake):
            self._awake = isinstance(command, Wake)
        elif isinstance(command, Look | Move | Perform | Posture | Walk) and not self._awake:
            raise RobotRefusedError("the motors are off: `wake` first")
        self.performed.append((now, command))
        row = row_of(command)
        behaves = self._behaves.get(row.verb)
        if behaves == "fails":
            raise RobotFailedError(f"{row.verb} fails in this story")
        if isinstance(command, Posture):
            self._angles.update(self.body.postures[command.name])
        elif isinstance(command, Look):
            self._angles.update(self.body.roles.head_joints(command.yaw, command.pitch))
        usual = row.duration(command)
        until = now + (inf if behaves == "hangs" else usual if behaves is None else float(behaves))
        if isinstance(command, Say):
            self._life.say(command, until - now, now)
        if isinstance(command, Perform):
            return _Playing(until, now, CueNotifier(command.motion, self._notice))
        if isinstance(command, Walk | Move):
            return _Walking(until, now, command, self._reckoning)
        if isinstance(command, Record):
            return SilentRecording(command, until, self._notice)
        if isinstance(command, Do):
            return _Skill(until, whole_result(added_verb(command), self._results.get(command.skill, {})))
        return _Lasting(until)

    def _offsets(self) -> Mapping[str, float]:
        """Return the offsets of joints that life and gestures add to the commands [rad; hands 0..1]."""
        free = {part for part in WHOLE_BODY if not self._executor.owner(part)}
        offsets = self._life.wanted(self.time, free, lambda _part: 1.0)
        for joint, angle in self._life.speech.wanted(self.time, free if LEGS in free else ()).items():
            offsets[joint] = offsets.get(joint, 0.0) + angle
        return offsets

    def _free(self, joint: str) -> bool:
        """Return True if no command owns that joint."""
        return not self._executor.owner(self._part.get(joint, ""))


def _face_of(visitor: Visitor) -> Vector3:
    """Return the position of a visitor's face relative to the torso of a robot on its podium [m]."""
    return visitor.x, visitor.y, visitor.height * FACE_HEIGHT_FRACTION - PODIUM_HEIGHT - TORSO_HEIGHT
