"""No command makes a joint leave its limits or its speed: tested with a robot that obeys everything."""

import re
import shutil
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import nan
from pathlib import Path
from typing import Any

import pytest

import lumen
from lumen import Exhibition
from lumen.bus.memory import MemoryBus
from lumen.language.commands import Language, Look, Posture
from lumen.language.events import Event
from lumen.language.motions import Cue, Interpolation, Keyframe, MotionDefinition
from lumen.language.robots import Body
from lumen.motion import bounds
from lumen.motion.bounds import nearest_angles
from lumen.motion.limits import COUPLED_TOLERANCE, beyond_limits, overspeed
from lumen.motion.trajectories import Trajectory
from lumen.ports import Aim, Idles, Joints, Live, Perform, RobotCommand, Sense
from lumen.robot.bounded_robot import BoundedRobot, ability
from lumen.robot.command_codec import decode_command, encode_command
from lumen.robot.recording import RecordingRobot
from lumen.robot.remote import RemoteRobot
from lumen.run.setup import set_up_with
from lumen.statechart import VirtualClock
from tests import ROOT
from tests.tables import for_each
from tests.tour.conftest import copied

NAO = lumen.load(ROOT).body
FAR = "{yaw: 121, pitch: 60}"
BEHAVIOUR = f"""\
units: {{angle: deg}}
life: calm
initial: a
states:
  a:
    do: [{{look: {FAR}}}, {{posture: Crouch}}, {{play: dance}}, {{track: head}}]
"""
HASTY = MotionDefinition("hasty", 0.2, {"HeadYaw": (Keyframe(0.1, 2.0), Keyframe(0.2, -2.0))})
FAR_MOTION = MotionDefinition("far", 2.0, {"HeadPitch": (Keyframe(1.0, 3.0), Keyframe(2.0, -3.0))})
SWUNG = (Keyframe(1.0, 2.0, Interpolation.BEZIER, handle_out=(0.3, 2.0)), Keyframe(2.0, 2.0, Interpolation.BEZIER))
COMMANDS: tuple[RobotCommand, ...] = (
    Look(9.0, 9.0),
    Look(-9.0, -9.0),
    Look(2.0, 0.5),
    Aim({"HeadYaw": 9.0, "HeadPitch": 9.0}, 5.0),
    Aim({"LShoulderPitch": -9.0, "LHand": 9.0}, 1.0),
    Perform(HASTY),
    Perform(FAR_MOTION),
    Perform(MotionDefinition("swung", 2.0, {"HeadYaw": SWUNG})),
    Posture("Crouch", 1.0),
)
KEPT = COMMANDS[-1:]
"""The commands of these that ask for nothing beyond the limits."""


@dataclass
class Obedient:
    """A robot that performs each command at once; `told` has the commands, each with the joints' angles before it."""

    body: Body = NAO
    clock: VirtualClock = field(default_factory=VirtualClock)
    told: list[tuple[Mapping[str, float], RobotCommand]] = field(default_factory=list)
    answers: list[Event] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.angles = dict(self.body.postures["Stand"])

    def start(self, id: str, command: RobotCommand) -> None:
        self.told.append((dict(self.angles), command))
        match command:
            case Look(yaw, pitch):
                self.angles |= self.body.roles.head_joints(yaw, pitch)
            case Aim(angles):
                self.angles |= angles
            case Posture(name):
                self.angles |= self.body.postures[name]
            case Perform(motion):
                self.angles |= Trajectory(motion).sample(motion.duration)
        if not isinstance(command, Aim | Live):
            self.answers.append(Event(f"done.command.{id}", None, 0.0))

    def cancel(self, id: str) -> None:
        """Do nothing: everything is over at once."""

    def poll(self) -> Sequence[Event]:
        answers, self.answers = self.answers, []
        return answers

    def begun(self) -> Sequence[str]:
        return ()

    def read(self, sense: Sense) -> Joints | None:
        if sense is not Sense.JOINT:
            return None
        return Joints(self.clock.now(), tuple(self.angles), tuple(self.angles.values()), (1.0,) * len(self.angles))

    def close(self) -> None:
        """Do nothing."""

    def kinds(self) -> set[type]:
        return {type(command) for _, command in self.told}


def outside(command: RobotCommand, body: Body) -> list[str]:
    """Return all demands of the command beyond the limits or the speed of a joint."""
    match command:
        case Look(yaw, pitch):
            return _outside(body.roles.head_joints(yaw, pitch), body)
        case Aim(angles, speed):
            return _outside(angles, body) + ([] if 0 < speed <= 1 else [f"at {speed} of the greatest speed"])
        case Posture(name, speed):
            return _outside(body.postures[name], body) + ([] if 0 < speed <= 1 else [f"at {speed}"])
        case Perform(motion):
            return [
                f"{excess.joint}: {excess.value}" for excess in (*beyond_limits(motion, body), *overspeed(motion, body))
            ]
    return []


def _outside(angles: Mapping[str, float], body: Body) -> list[str]:
    near = nearest_angles(angles, body)
    return [f"{name}: {angle}" for name, angle in angles.items() if abs(angle - near[name]) > COUPLED_TOLERANCE]


def faults(robot: Obedient) -> list[str]:
    return [fault for _, command in robot.told for fault in outside(command, robot.body)]


def opened(folder: Path, robot: Obedient) -> Exhibition:
    """Return the shipped exhibition with a behaviour that asks for too much."""
    copied(folder)
    shutil.rmtree(folder / "behaviors")
    (folder / "behaviors").mkdir()
    settings = (folder / "lumen.yaml").read_text("utf-8")
    (folder / "lumen.yaml").write_text(re.sub("(?m)^story: .*$", "", settings), "utf-8")
    (folder / "behaviors/tour.yaml").write_text(BEHAVIOUR, "utf-8")
    return lumen.open(folder, robot=robot, clock=robot.clock)


def test_without_the_layer_this_robot_is_told_too_much() -> None:
    for command in COMMANDS:
        assert outside(command, NAO) or command in KEPT


@for_each("command", COMMANDS)
def test_a_robot_of_ones_own_is_told_no_command_beyond_its_limits(command: RobotCommand) -> None:
    own = Obedient()
    BoundedRobot(own, NAO).start("a", command)
    assert [type(told) for _, told in own.told] == [type(command)]
    assert not faults(own)


def test_a_motion_is_delayed_until_the_joints_can_reach_its_first_key() -> None:
    own = Obedient()
    robot = BoundedRobot(own, NAO)
    robot.start("a", Look(-2.0))
    nod = MotionDefinition("nod", 1.0, {"HeadYaw": (Keyframe(0.2, 2.0), Keyframe(1.0, 0.0))}, (Cue(0.2, "say", "now"),))
    robot.start("b", Perform(nod))
    [_, (here, command)] = own.told
    assert isinstance(command, Perform)
    [way] = Trajectory(command.motion, here).tracks
    assert here["HeadYaw"] == -2.0
    assert max(segment.peak_speed() for segment in way.segments) <= NAO.joints["HeadYaw"].speed
    assert command.motion.cues[0].time == way.ends[0] > 0.2
    assert command.motion.duration == pytest.approx(way.ends[0] + 0.8)


@for_each(
    ("before", "aim", "angles"),
    [
        (Look(0.0, 0.5), Aim({"HeadYaw": 2.0}), {"HeadYaw", "HeadPitch"}),
        (Look(2.0, 0.0), Aim({"HeadPitch": 0.5}), {"HeadPitch"}),
        (Look(0.0, 0.1), Aim({"HeadYaw": 0.1}), {"HeadYaw"}),
    ],
)
def test_an_aim_keeps_limits_that_depend_on_another_joint(before: Look, aim: Aim, angles: set[str]) -> None:
    own = Obedient()
    robot = BoundedRobot(own, NAO)
    robot.start("a", before)
    robot.start("", aim)
    [_, (_, told)] = own.told
    assert isinstance(told, Aim)
    assert told.angles.keys() == angles
    head = {name: own.angles[name] for name in ("HeadYaw", "HeadPitch")}
    assert nearest_angles(head, NAO) == head


def test_a_motion_that_no_change_brings_within_the_limits_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bounds, "MAX_FITS", 1)
    own = Obedient()
    robot = BoundedRobot(own, NAO)
    robot.start("a", Perform(replace(FAR_MOTION, tracks={**FAR_MOTION.tracks, "HeadYaw": SWUNG})))
    assert [event.name for event in robot.poll()] == ["error.command.a"]
    assert not own.told


def test_what_it_can_not_perform_is_refused_and_not_told() -> None:
    own = Obedient()
    robot = BoundedRobot(own, NAO)
    robot.start("a", Look(nan))
    robot.start("", Aim({"Nose": 0.1}))
    robot.start("b", Look(0.1))
    assert [event.name for event in robot.poll()] == ["error.command.a", "done.command.b"]
    assert [command for _, command in own.told] == [Look(0.1)]


def test_no_sender_moves_a_joint_beyond_its_limits(tmp_path: Path) -> None:
    """Senders are the behaviour, its controller and its life, modules on the bus, and a program in this process."""
    own = Obedient()
    with opened(tmp_path, own) as exhibition:
        exhibition.run(seconds=1)
        assert {Look, Posture, Perform, Live} <= own.kinds()
        own.told.clear()
        for _ in range(100):
            exhibition.send("face", {"x": 0.0, "y": 0.0})
            exhibition.run(seconds=0.1)
        assert Aim in own.kinds(), "the controller aims the head"
        own.told.clear()
        for command in COMMANDS:
            exhibition.send("aim" if isinstance(command, Aim) else "command", encode_command(command))
            exhibition.run(seconds=0.2)
        assert {Look, Posture, Perform, Aim} <= own.kinds()
        for command in COMMANDS:
            exhibition.services.setup.robot.start("operator", command)
        assert not faults(own)


def test_a_brain_elsewhere_sends_no_command_beyond_the_limits() -> None:
    """The robot on the other side of the bus may be another program, which checks nothing."""
    project, bus, bodies = lumen.load(ROOT), MemoryBus(), list[Any]()
    bus.subscribe("#", lambda message: bodies.append(message.body))
    robot = RemoteRobot(project, bus, lambda: 0.0, patience=lambda: 0.0)
    for i, command in enumerate(COMMANDS):
        robot.start(f"{i}", command)
    robot.start("nan", Look(nan))
    assert [event.name for event in robot.poll()] == ["error.command.nan"]
    sent = [decode_command(body, project) for body in bodies]
    assert [type(command) for command in sent] == [type(command) for command in COMMANDS]
    assert not [fault for command in sent if not isinstance(command, Language) for fault in outside(command, NAO)]


def test_a_wrapped_robot_has_the_abilities_of_the_one_within() -> None:
    recording = RecordingRobot(NAO)
    wrapped = BoundedRobot(recording, NAO)
    assert ability(wrapped, Idles) is ability(recording, Idles) is recording
    assert ability(BoundedRobot(Obedient(), NAO), Idles) is None
    setup = set_up_with(wrapped)
    setup.clock.wait(1.0)
    assert setup.robot is wrapped
    assert setup.hall is recording
    assert recording.time == pytest.approx(1.0)
    assert set_up_with(BoundedRobot(Obedient(), NAO)).hall is None
