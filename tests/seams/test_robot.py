"""One set of promises for every robot; an adapter is a row in `ROBOTS`. test_shipped_promises.py has more."""

from collections.abc import Callable, Iterator
from math import nan
from typing import Protocol

import pytest

import lumen
from lumen.bus import connect
from lumen.bus.validated import validated
from lumen.features.simulation.offers import SimulatedRobot
from lumen.language.commands import Leds, Look, Move, Posture, Rest, Say, Stop, Volume
from lumen.language.events import Event
from lumen.language.motions import Keyframe, MotionDefinition
from lumen.language.projects import Project
from lumen.language.stories import Visitor
from lumen.ports import Aim, Battery, Hall, Joints, Live, Perform, Record, Robot, RobotCommand, Sense, Sonar, Tactile
from lumen.robot.recording import RecordingRobot
from lumen.robot.remote import RemoteHall, RemoteRobot, RobotHost
from tests import ROOT
from tests.features.naoqi.lockstep import Lockstep
from tests.waiting import HANG, until


class Body(Robot, Hall, Protocol):
    """A robot whose time a test advances."""

    def advance(self, dt: float) -> None: ...


def simulated(project: Project) -> Body:
    return SimulatedRobot(project.body, ROOT / "models", project.hall)


def recording(project: Project) -> Body:
    return RecordingRobot(project.body)


class Remote(RemoteRobot):
    """The recording robot and its hall on the other side of a bus, and the seam on this side."""

    def __init__(self, project: Project) -> None:
        self._far, wire = RecordingRobot(project.body), validated(connect("memory://"), project)
        self._host = RobotHost(project, self._far, wire, self._far)
        self._hall = RemoteHall(project, wire)
        super().__init__(project, wire, lambda: self._far.time, patience=lambda: self._far.time)
        self.advance(0.02)
        self.place, self.face, self.touch = self._hall.place, self._hall.face, self._hall.touch

    def plug(self, plugged: bool) -> None:
        self._hall.plug(plugged)
        self.advance(5.0)

    def advance(self, dt: float) -> None:
        self._far.advance(dt)
        self._host.tick(self._far.time)
        until(lambda: self._host.server.settle(HANG), what="its senses are published")

    def close(self) -> None:
        super().close()
        self._hall.close()
        self._host.close()


ROBOTS: dict[str, Callable[[Project], Body]] = {
    "simulation": simulated,
    "recording": recording,
    "remote": Remote,
    "naoqi": Lockstep,
}


@pytest.fixture(scope="module")
def project() -> Project:
    return lumen.load(ROOT)


@pytest.fixture(params=ROBOTS.values(), ids=list(ROBOTS))
def robot(request: pytest.FixtureRequest, project: Project) -> Iterator[Body]:
    one = request.param(project)
    yield one
    one.close()


def live(robot: Body, seconds: float) -> list[Event]:
    """Return the robot's answers and observations in this time [s]."""
    events: list[Event] = []
    for _ in range(round(seconds / 0.02)):
        robot.advance(0.02)
        events += robot.poll()
    return events


def names(events: list[Event]) -> list[str]:
    return [event.name for event in events]


def test_a_command_is_answered_once_and_in_time(robot: Body) -> None:
    robot.start("a", Say("Hello there"))
    robot.start("b", Look(0.3, 0.1))
    events = live(robot, 4.0)
    assert sorted(names(events)) == ["done.command.a", "done.command.b"]
    assert all(0 < event.at <= 4.02 for event in events)
    assert live(robot, 0.5) == []


def test_speech_takes_its_time(robot: Body) -> None:
    robot.start("a", Say("x" * 20))
    [done] = live(robot, 3.0)
    assert done.at == pytest.approx(1.6, abs=0.1)


@pytest.mark.parametrize("command", [Look(nan), Perform(MotionDefinition("m", 1.0, {"Nose": (Keyframe(1.0, 0.1),)}))])
def test_what_is_no_goal_for_its_joints_is_refused(robot: Body, command: RobotCommand) -> None:
    robot.start("a", command)
    [answer] = live(robot, 6.0)
    assert answer.name == "error.command.a"


def test_its_volume_is_set_while_it_speaks(robot: Body) -> None:
    robot.start("a", Say("A text that takes a while."))
    live(robot, 0.2)
    robot.start("b", Volume(0.4))
    robot.start("c", Volume(1.01))
    done, refused = [event for event in live(robot, 0.4) if "command" in event.name]
    assert {done.name, refused.name} == {"done.command.b", "error.command.c"}
    assert [name for name in names(live(robot, 6.0)) if "command" in name] == ["done.command.a"]


def test_lights_take_their_time_and_leave_the_body_alone(robot: Body) -> None:
    robot.start("a", Leds({"eyes": "rebeccapurple", "chest": "#12a0ff"}, 1.0))
    robot.start("b", Leds({"feet": "green"}))
    robot.start("c", Leds({"left_eye": "red"}, 0.2))
    robot.start("d", Look(0.3, 0.1))
    events = live(robot, 3.0)
    assert [n for n in names(events) if not n.endswith("d")] == [f"done.command.{id}" for id in "bac"]
    ended = {event.name[-1]: event.at for event in events}
    assert (ended["a"], ended["b"], ended["c"]) == pytest.approx((1.0, 0.0, 1.2), abs=0.15)
    assert ended["d"] < 1.2


@pytest.mark.parametrize("colours", [{"eyes": "bleu"}, {"eye": "blue"}, {"eyes": "#12g"}, {}])
def test_lights_and_colours_that_it_does_not_have_are_an_answer(robot: Body, colours: dict[str, str]) -> None:
    robot.start("a", Leds(colours))
    [answer] = live(robot, 0.3)
    assert answer.name == "error.command.a"
    assert all(
        text in answer.data["reason"] for pair in colours.items() for text in pair if text not in ("eyes", "blue")
    )


def test_cancelled_lights_are_at_their_goal_at_once(robot: Body) -> None:
    robot.start("a", Leds({"eyes": "red"}, 30.0))
    live(robot, 0.2)
    robot.cancel("a")
    assert names(live(robot, 0.6)) == ["cancelled.command.a"]


def test_a_cancelled_command_says_so_within_a_second(robot: Body) -> None:
    robot.start("a", Posture("StandInit", 0.2))
    live(robot, 0.2)
    robot.cancel("a")
    robot.cancel("a")
    robot.cancel("nobody")
    [answer] = live(robot, 1.0)
    assert answer.name == "cancelled.command.a"


@pytest.mark.slow
def test_one_motion_after_the_other(robot: Body, project: Project) -> None:
    robot.start("a", Perform(project.motions["goodbye"]))
    robot.start("b", Perform(project.motions["goodbye"]))
    assert names(live(robot, 2 * project.motions["goodbye"].duration + 2.0)) == ["done.command.a", "done.command.b"]


@pytest.mark.slow
def test_rest_comes_before_everything(robot: Body, project: Project) -> None:
    robot.start("dance", Perform(project.motions["dance"]))
    robot.start("say", Say("x" * 200))
    live(robot, 0.5)
    robot.start("later", Posture("Stand"))
    robot.start("rest", Rest())
    answers = names(live(robot, 8.0))
    assert set(answers[:3]) == {"cancelled.command.dance", "cancelled.command.say", "cancelled.command.later"}
    assert answers[3] == "done.command.rest"


@pytest.mark.slow
def test_stop_ends_what_it_names_and_nothing_else(robot: Body, project: Project) -> None:
    robot.start("dance", Perform(project.motions["dance"]))
    robot.start("say", Say("x" * 30))
    live(robot, 0.5)
    robot.start("stop", Stop("play"))
    assert names(live(robot, 4.0)) == ["cancelled.command.dance", "done.command.stop", "done.command.say"]


def test_an_aim_moves_the_head_and_is_not_answered(robot: Body) -> None:
    robot.start("", Aim({"HeadYaw": 0.4}, 0.5))
    assert live(robot, 2.0) == []
    joints = robot.read(Sense.JOINT)
    assert isinstance(joints, Joints)
    assert joints.angles[joints.names.index("HeadYaw")] == pytest.approx(0.4, abs=0.03)


def test_an_aim_leaves_alone_what_a_command_owns(robot: Body) -> None:
    robot.start("look", Look(0.3, 0.0))
    live(robot, 0.1)
    robot.start("", Aim({"HeadYaw": -0.5}, 0.5))
    assert names(live(robot, 2.0)) == ["done.command.look"]
    joints = robot.read(Sense.JOINT)
    assert isinstance(joints, Joints)
    assert joints.angles[joints.names.index("HeadYaw")] == pytest.approx(0.3, abs=0.03)


@pytest.mark.slow
def test_a_motion_owns_what_it_moves_and_nothing_else(robot: Body, project: Project) -> None:
    motion = project.motions["photo"]
    assert "HeadYaw" not in motion.tracks
    robot.start("photo", Perform(motion))
    robot.start("say", Say("Smile"))
    robot.start("look", Look(0.3, 0.0))
    assert live(robot, 0.1) == []
    robot.start("stand", Posture("Stand"))
    answers = names(live(robot, motion.duration + 6.0))
    assert set(answers[:2]) == {"done.command.say", "done.command.look"}
    assert answers[2:] == ["done.command.photo", "done.command.stand"]


@pytest.mark.parametrize("angle", [9.0, -9.0])
def test_no_aim_leaves_the_limits(robot: Body, project: Project, angle: float) -> None:
    robot.start("", Aim({"HeadPitch": angle}, 1.0))
    live(robot, 2.0)
    joints = robot.read(Sense.JOINT)
    assert isinstance(joints, Joints)
    limit = project.body.joints["HeadPitch"]
    measured = joints.angles[joints.names.index("HeadPitch")]
    assert limit.minimum - 0.05 <= measured <= limit.maximum + 0.05


BEYOND = (
    Look(9.0, 9.0),
    Perform(MotionDefinition("far", 0.5, {"HeadYaw": (Keyframe(0.3, -9.0),), "LHand": (Keyframe(0.3, 3.0),)})),
    Perform(MotionDefinition("hasty", 0.2, {"HeadYaw": (Keyframe(0.1, 2.0), Keyframe(0.2, -2.0))})),
)


@pytest.mark.parametrize("command", BEYOND, ids=["look", "far", "hasty"])
def test_no_command_leaves_the_limits(robot: Body, project: Project, command: RobotCommand) -> None:
    """Its life moves it at the same time; a robot with a body may sag or swing by 0.05 rad."""
    robot.start("", Live(project.life["lively"]))
    robot.start("a", command)
    answers: list[str] = []
    for _ in range(20):
        answers += names(live(robot, 0.2))
        joints = robot.read(Sense.JOINT)
        assert isinstance(joints, Joints)
        for name, angle in zip(joints.names, joints.angles, strict=True):
            assert project.body.joints[name].minimum - 0.05 <= angle <= project.body.joints[name].maximum + 0.05, name
    assert answers == ["done.command.a"]


@pytest.mark.slow
def test_a_move_goes_on_until_another_one_or_stop_ends_it(robot: Body) -> None:
    robot.start("a", Move(0.02))
    assert live(robot, 2.0) == []
    robot.start("b", Move(0.0, 0.0, 0.1))
    assert names(live(robot, 0.5)) == ["done.command.a"]
    robot.start("s", Stop("walk"))
    assert sorted(names(live(robot, 1.5))) == ["cancelled.command.b", "done.command.s"]


@pytest.mark.slow
def test_a_recording_takes_its_time_while_everything_else_goes_on(robot: Body) -> None:
    robot.start("ears", Record("r1", 1.0))
    robot.start("say", Say("Hello"))
    answers = [e for e in live(robot, 2.0) if ".command." in e.name]
    assert names(answers) == ["done.command.say", "done.command.ears"]
    assert answers[1].at == pytest.approx(1.0, abs=0.3)
    robot.start("again", Record("r2", 5.0))
    live(robot, 0.5)
    robot.cancel("again")
    assert names(live(robot, 1.0)) == ["cancelled.command.again"]


def test_senses_in_their_order_and_units(robot: Body, project: Project) -> None:
    live(robot, 0.1)
    joints, sonar = robot.read(Sense.JOINT), robot.read(Sense.SONAR)
    tactile, battery = robot.read(Sense.TACTILE), robot.read(Sense.BATTERY)
    assert isinstance(joints, Joints)
    assert joints.names == tuple(project.body.joints)
    assert len(joints.angles) == len(joints.stiffness) == 26
    assert isinstance(sonar, Sonar)
    assert 0 < sonar.left <= 3.0
    assert isinstance(tactile, Tactile)
    assert tactile.names == project.body.tactile
    assert set(tactile.values) == {0}
    assert isinstance(battery, Battery)
    assert 0 <= battery.percentage <= 100


def test_a_visitor_is_seen_until_they_leave(robot: Body, project: Project) -> None:
    live(robot, 0.1)
    assert robot.face() is None
    robot.place(Visitor(2.0, 0.0, 1.65))
    live(robot, 0.1)
    face = robot.face()
    assert face is not None
    assert abs(face[0] - project.body.camera.width / 2) < 10
    robot.place(Visitor(2.0, 0.3, 1.65))
    live(robot, 0.1)
    beside = robot.face()
    assert beside is not None
    assert beside[0] < face[0] - 20
    robot.place(None)
    live(robot, 0.1)
    assert robot.face() is None
