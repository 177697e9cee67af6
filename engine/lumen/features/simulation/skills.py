"""A simulated robot's abilities: the body parts that each command owns, and the activity that performs it."""

from collections.abc import Callable
from math import inf, pi
from typing import assert_never

from lumen.errors import BadCommandError, RobotRefusedError
from lumen.features.simulation.base import RobotBase
from lumen.features.simulation.joint_transition import JointTransition
from lumen.features.simulation.lights import LightFade, Lights
from lumen.features.simulation.motors import Motors
from lumen.features.simulation.playback import MotionPlayback, SpeechActivity
from lumen.features.simulation.posture_planner import PosturePlanner, PostureState, lying
from lumen.features.simulation.sensors import BodySensors
from lumen.features.simulation.sound_playback import (
    SilentPlayback,
    SilentSounds,
    SoundActivity,
    SoundPlayback,
    SpeechPlayback,
)
from lumen.features.simulation.world import World
from lumen.language.body_parts import part_of
from lumen.language.commands import Leds, Look, Move, PlaySound, Posture, Rest, Say, Stop, Volume, Wake, Walk
from lumen.motion.postures import RESTFUL, standing
from lumen.ports import Aim, Live, NativeCommand, Perform, Record, RobotCommand
from lumen.robot.command_table import parts_of, row_of
from lumen.robot.cues import EventSink
from lumen.robot.executor import Activity
from lumen.robot.joint_ways import LOOK_SPEED, home_angles
from lumen.robot.silent_recording import SilentRecording

FALLEN_STIFFNESS = 0.1
"""The stiffness of a fallen robot."""

PROTECTING_STIFFNESS, PROTECTING_TIME = 0.6, 0.7
"""The stiffness of head and arms during a fall, and the assumed duration of the fall [s]."""

BREAKS_A_FALL = {
    "head.pitch": -0.6,
    "arms.left.shoulder-pitch": 0.2,
    "arms.right.shoulder-pitch": 0.2,
    "arms.left.elbow-roll": -0.9,
    "arms.right.elbow-roll": 0.9,
}
"""The angles of head and arms in a forward or sideways fall [rad]. In trials, no angles helped in a backward fall."""

FIRST_POSTURE = "Stand"
"""The posture that every body has."""

BACKWARDS = 0.3
"""The forward component of the upward direction, in the torso's axes, from which the robot falls on its back."""

FULL_VOLUME = 1.0
"""The volume of speech before any `volume` command."""

_REST_SPEED, _WAKE_SPEED = 0.3, 0.4
_UPRIGHT = pi / 9


class SimulatedSkills:
    """Begins activities, and records whether the robot is awake or fallen, and its posture.

    `notice` receives a motion's cue events; `playing` is the motion begun last, None before the first.
    """

    def __init__(
        self,
        world: World,
        motors: Motors,
        lights: Lights,
        base: RobotBase,
        sensors: BodySensors,
        posture: str,
        notice: EventSink,
    ) -> None:
        self._world, self._motors, self._lights, self._base = world, motors, lights, base
        self._sensors, self._notice = sensors, notice
        self._part = part_of(world.body)
        self._standing = standing(world.body)
        self._posture_state = PostureState(posture, self._standing)
        roles = world.body.roles
        found = [(roles.joint(path), angle) for path, angle in BREAKS_A_FALL.items()]
        self._breaks_a_fall = {role.joint: role.sign * angle for role, angle in found if role}
        self._way: PosturePlanner | None = None
        self.playing: MotionPlayback | None = None
        self.awake, self.fallen = True, False
        self._down_at = inf
        self.voice: SpeechPlayback = SilentPlayback()
        self.sounds: SoundPlayback = SilentSounds()
        self.volume = FULL_VOLUME

    @property
    def upright(self) -> bool:
        """True if the robot is in a standing posture and on no passage between postures."""
        return self._posture_state.upright and not (self._way and self._way.passing)

    @property
    def posture(self) -> str:
        """The posture that the robot is in or leaving."""
        return self._posture_state.posture

    def parts(self, command: RobotCommand) -> frozenset[str]:
        """Return the body parts that a command owns."""
        return parts_of(command, self._world.body)

    def part(self, joint: str) -> str:
        """Return the body part of a joint; empty for an unknown joint."""
        return self._part.get(joint, "")

    def begin(self, command: NativeCommand, now: float) -> Activity:
        """Begin a command and return its activity. Raises RobotError if the robot can't begin it."""
        if row_of(command).moves and not isinstance(command, Wake | Posture):
            self._ready()
        match command:
            case Say():
                return SpeechActivity(self._lights, self.voice, command, self.volume, now)
            case Record(_, duration):
                return SilentRecording(command, now + duration, self._notice)
            case Perform():
                return self._perform(command, now)
            case Posture(name, speed):
                return self._posture(name, speed, now)
            case Look(yaw, pitch):
                return self._look(yaw, pitch, now)
            case Leds(colours, seconds):
                return LightFade(self._lights, colours, seconds, now)
            case Volume(level):
                self.volume = level
                return JointTransition(self._motors, {}, now, 0.01)
            case PlaySound():
                return SoundActivity(self.sounds, command, self.volume, now)
            case Rest():
                return self._rest(now)
            case Wake():
                return self._wake(now)
            case Walk() | Move():
                if not self.upright:
                    raise RobotRefusedError(f"the robot is in {self._posture_state.posture}: send it to Stand first")
                return self._base.walk(command, now)
            case Stop() | Aim() | Live():
                raise BadCommandError(f"{type(command).__name__} has no duration")
            case _:
                assert_never(command)

    def fall(self, now: float) -> None:
        """Make the falling robot limp and record the fall.

        Unless the robot falls on its back, its head and arms protect it until `lie` releases them. Legs would be too
        slow to help.
        """
        self.fallen, self._way, self._down_at = True, None, now + PROTECTING_TIME
        self._motors.stiffen(FALLEN_STIFFNESS)
        if self._sensors.up[0] < BACKWARDS:
            self._motors.stiffen(PROTECTING_STIFFNESS, self._breaks_a_fall)
            self._motors.aim(self._breaks_a_fall)
        self._lights.reset()

    def lie(self, now: float) -> None:
        """Release head and arms when the fall is over."""
        if self.fallen and now >= self._down_at:
            self._motors.stiffen(FALLEN_STIFFNESS)
            self._down_at = inf

    def _ready(self) -> None:
        if self.fallen:
            raise RobotRefusedError("the robot has fallen: `wake` it first")
        if not self.awake:
            raise RobotRefusedError("the motors are off: `wake` first")

    def _perform(self, command: Perform, now: float) -> Activity:
        motion = command.motion
        home = home_angles(motion, self._world.body, self.parts(command))
        here = self._posture_state.posture
        if motion.start and motion.start != here and not (self.upright and motion.start in self._standing):
            raise RobotRefusedError(
                f"`{motion.name}` begins in {motion.start}; the robot is in {here}: send it there first"
            )
        self.playing = MotionPlayback(self._motors, self._lights, motion, home, now, self._notice)
        return self.playing

    def _posture(self, name: str, speed: float, now: float) -> Activity:
        if not self.awake and not self.fallen:
            raise RobotRefusedError("the motors are off: `wake` first")
        return self._go((name,), now, speed)

    def _go(
        self, goals: tuple[str, ...], now: float, speed: float, after: Callable[[], None] | None = None
    ) -> PosturePlanner:
        """Return the activity that leads to the nearest of these postures; a limp robot begins as it lies or sits.

        Raises RobotRefusedError if a fallen robot is neither lying nor upright, or if no route leads to a goal.
        """
        limp, down = self.fallen or not self.awake, lying(self._sensors)
        if limp and down:
            self._posture_state = PostureState(down, self._standing)
        elif self.fallen:
            if self._world.tilt > _UPRIGHT:
                raise RobotRefusedError("the robot has fallen but is not lying down: set it on its feet first")
            self._posture_state = PostureState(FIRST_POSTURE, self._standing)
        if limp:
            self._motors.stiffen(1.0)
            self.awake, self.fallen = True, False
        self._way = PosturePlanner(
            self._motors,
            self._world.body,
            self._sensors,
            self._posture_state,
            goals,
            now,
            speed=speed,
            settle=limp and not self._posture_state.upright,
            after=after,
        )
        return self._way

    def _look(self, yaw: float, pitch: float, now: float) -> Activity:
        angles = self._world.body.roles.head_joints(yaw, pitch)
        wanted = self._motors.wanted(angles)
        farthest = max(abs(angle - wanted[name]) for name, angle in angles.items())
        return JointTransition(self._motors, angles, now, max(0.3, farthest / LOOK_SPEED))

    def _rest(self, now: float) -> Activity:
        if self.fallen or not self.awake or not self._world.body.roles.base.row.legs:
            self._sleep()
            return JointTransition(self._motors, {}, now, 0.01)
        return self._go(RESTFUL, now, _REST_SPEED, self._sleep)

    def _wake(self, now: float) -> Activity:
        return self._go(("Stand",), now, _WAKE_SPEED)

    def _sleep(self) -> None:
        self.awake = False
        self._motors.stiffen(0.0)
        self._lights.reset()
