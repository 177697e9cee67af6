"""What the simulated NAO can do: each command's parts of the body, and how it begins."""

from math import pi
from typing import assert_never

from lumen.errors import RobotError
from lumen.language.commands import Look, Posture, Rest, Say, Stop, Wake, Walk
from lumen.ports import Aim, Perform, RobotCommand
from lumen.robots.executor import Activity
from lumen.robots.parts import part_of, parts
from lumen.robots.simulation.lights import Lights
from lumen.robots.simulation.motors import Motors
from lumen.robots.simulation.performance import Performance, Speech
from lumen.robots.simulation.transition import Transition, duration
from lumen.robots.simulation.walking import Walker
from lumen.robots.simulation.world import World

POSTURES = ("Stand", "StandInit", "StandZero", "Crouch")
"""Those that a straight way connects; the others need more than that."""

SOFT = 0.1
"""Stiffness of a robot that has fallen."""

_LOOK_SPEED = 1.5
_REST_TIME = 2.0
_UPRIGHT = pi / 9


class Repertoire:
    """Begins activities; knows whether the motors are on and whether the robot has fallen."""

    def __init__(self, world: World, motors: Motors, lights: Lights, walker: Walker) -> None:
        self._world, self._motors, self._lights, self._walker = world, motors, lights, walker
        self._postures = world.body.postures
        self._part = part_of(world.body)
        self.awake, self.fallen = True, False

    def parts(self, command: RobotCommand) -> frozenset[str]:
        """Which parts of the body a command owns."""
        return parts(command, self._world.body)

    def part(self, joint: str) -> str:
        """The part of the body that a joint belongs to."""
        return self._part.get(joint, "")

    def begin(self, command: RobotCommand, now: float) -> Activity:
        """The command under way. Raises RobotError where the robot can't."""
        if not isinstance(command, Say | Rest | Wake):
            self._ready()
        match command:
            case Say(text):
                return Speech(self._lights, text, now)
            case Perform():
                return self._perform(command, now)
            case Posture(name, speed):
                return self._posture(name, speed, now)
            case Look(yaw, pitch):
                return self._look(yaw, pitch, now)
            case Rest():
                return self._rest(now)
            case Wake():
                return self._wake(now)
            case Walk():
                return self._walker.begin(command, now)
            case Stop() | Aim():
                raise RobotError(f"{type(command).__name__} does not last")
            case _:
                assert_never(command)

    def fall(self) -> None:
        """Give way: the fall is over sooner than a motor could help."""
        self.fallen = True
        self._motors.stiffen(SOFT)
        self._lights.reset()

    def _ready(self) -> None:
        if self.fallen:
            raise RobotError("the robot has fallen: put it on its feet and wake it")
        if not self.awake:
            raise RobotError("the motors are off: `wake` first")

    def _perform(self, command: Perform, now: float) -> Activity:
        motion, owned = command.motion, self.parts(command)
        if motion.start and motion.start not in POSTURES:
            raise RobotError(f"`{motion.name}` begins in {motion.start}, {self._unreachable()}")
        start = self._postures.get(motion.start, {})
        home = {name: angle for name, angle in start.items() if self._part[name] in owned}
        return Performance(self._motors, self._lights, motion, home, now)

    def _posture(self, name: str, speed: float, now: float) -> Activity:
        if not 0 < speed <= 1:
            raise RobotError(f"a speed lies above 0 and up to 1, not at {speed}")
        if name not in POSTURES or name not in self._postures:
            raise RobotError(f"`{name}` is a posture {self._unreachable()}")
        return Transition(self._motors, self._postures[name], now, duration(speed))

    def _unreachable(self) -> str:
        return f"that the robot can't get into yet: it knows {', '.join(POSTURES)}"

    def _look(self, yaw: float, pitch: float, now: float) -> Activity:
        self._motors.check({"HeadYaw": yaw, "HeadPitch": pitch})
        target = {n: self._motors.inside(n, a) for n, a in (("HeadYaw", yaw), ("HeadPitch", pitch))}
        wanted = self._motors.wanted(target)
        farthest = max(abs(target[name] - wanted[name]) for name in target)
        return Transition(self._motors, target, now, max(0.3, farthest / _LOOK_SPEED))

    def _rest(self, now: float) -> Activity:
        if self.fallen or not self.awake:
            self._sleep()
            return Transition(self._motors, {}, now, 0.01)
        return Transition(self._motors, self._postures["Crouch"], now, _REST_TIME, self._sleep)

    def _wake(self, now: float) -> Activity:
        if self.fallen and self._world.tilt > _UPRIGHT:
            raise RobotError("the robot has fallen: put it on its feet first")
        self.awake, self.fallen = True, False
        self._motors.stiffen(1.0)
        return Transition(self._motors, self._postures["Stand"], now, duration(0.4))

    def _sleep(self) -> None:
        self.awake = False
        self._motors.stiffen(0.0)
        self._lights.reset()
