"""Presence, the guard over a brain, and commands to a robot that does not answer: in virtual time."""

from collections.abc import Iterator
from math import inf
from types import SimpleNamespace
from typing import Any

import pytest

import lumen
from lumen.bus import Bus, BusError, connect
from lumen.bus.validated import validated
from lumen.language.commands import Look, Posture, Rest, Say, Stop, Track
from lumen.language.events import Event
from lumen.ports import Aim, Message, Perform
from lumen.project.packaged import shipped_root
from lumen.robot.recording import RecordingRobot
from lumen.robot.remote import RemoteRobot
from lumen.run.delegated_tracking import DelegatedTracking, motion_key
from lumen.run.parts.guard import BrainGuard
from lumen.run.parts.motion import MotionPart
from lumen.run.presence import LOST_AFTER, MAX_PEERS, Presence
from tests.exhibits import BODY, JOINTS, messages, project
from tests.nodes import Printed

PROJECT = project(messages=messages())


class Hall:
    """A bus and a clock that the test advances."""

    def __init__(self) -> None:
        self.bus, self.time = connect("memory://"), 0.0
        self.sent: list[Message] = []
        self.bus.subscribe("#", self.sent.append)

    def presence(self, *parts: str, session: str = "", **said: Any) -> Presence:
        return Presence(self.bus, "NAO", parts, session=session, clock=lambda: self.time, more=lambda: said)

    def live(self, seconds: float, *present: Presence) -> list[list[Event]]:
        found: list[list[Event]] = [[] for _ in present]
        for _ in range(round(seconds / 0.1)):
            self.time += 0.1
            for one, events in zip(present, found, strict=True):
                events += one.tick()
        return found

    def of(self, key: str) -> list[Any]:
        return [message.body for message in self.sent if message.key == key]


@pytest.fixture
def hall() -> Iterator[Hall]:
    one = Hall()
    yield one
    one.bus.close()


def test_who_falls_silent_is_lost_and_comes_back(hall: Hall) -> None:
    brain, robot = hall.presence("brain"), hall.presence("robot")
    for one in (brain, robot):
        one.settle()
    assert hall.live(1.0, brain, robot) == [[], []]
    assert brain.find("robot")
    assert hall.live(3.0, brain) == [[]]
    [lost] = hall.live(1.5, brain)
    assert [event.name for event in lost] == ["robot.lost"]
    [back, _] = hall.live(1.0, brain, robot)
    assert [event.name for event in back] == ["robot.back"]
    assert back[0].data["seconds"] == pytest.approx(4.5, abs=0.6)


def test_who_leaves_is_gone_at_once_and_who_was_never_there_is_not_lost(hall: Hall) -> None:
    brain, motion = hall.presence("brain"), hall.presence("motion")
    brain.settle()
    motion.settle()
    hall.live(1.0, brain, motion)
    motion.close()
    motion.close()
    [lost] = hall.live(0.2, brain)
    assert [event.name for event in lost] == ["motion.lost"]


def test_of_two_that_ask_at_the_same_time_one_is_refused(hall: Hall) -> None:
    one, other = hall.presence("brain", session="a"), hall.presence("brain", session="b")
    hall.live(0.5, one, other)
    assert one.rival("brain") is None
    assert other.rival("brain")
    one.settle()
    hall.live(0.5, one, other)
    assert other.rival("brain")
    late = hall.presence("brain", session="0")
    hall.live(0.3, late, one)
    assert late.rival("brain")
    assert one.rival("brain") is None


def test_a_robot_of_another_name_and_nonsense_are_nobody(hall: Hall) -> None:
    brain = hall.presence("brain")
    good = {"robot": "NAO", "parts": ["robot"], "session": "x", "state": "here"}
    for body in ({**good, "robot": "KURNIA"}, {**good, "parts": "robot"}, None, 7, {**good, "session": 3}):
        hall.bus.publish("lumen.presence", body)
    hall.live(0.2, brain)
    assert brain.peers() == []
    for i in range(3 * MAX_PEERS):
        hall.bus.publish("lumen.presence", {**good, "session": str(i)})
    hall.live(LOST_AFTER + 0.5, brain)
    hall.bus.publish("lumen.presence", good)
    hall.live(0.2, brain)
    assert len(brain._peers) <= MAX_PEERS


def test_a_robot_rests_when_its_brain_is_gone_and_tells_the_next_one(hall: Hall) -> None:
    robot, presence, brain = RecordingRobot(BODY), hall.presence("robot"), hall.presence("brain")
    noticed: list[Event] = []
    guard = BrainGuard(robot, presence, noticed.append, lambda line: None, lambda: hall.time)

    def live(seconds: float, *others: Presence) -> None:
        for _ in range(round(seconds / 0.1)):
            hall.live(0.1, presence, *others)
            robot.advance(0.1)
            guard.tick(hall.time)

    presence.settle()
    live(8.0)
    assert robot.performed == []
    brain.settle()
    live(1.0, brain)
    assert guard.follows == brain.session
    live(4.5)
    assert robot.performed == []
    live(1.0)
    assert [command for _, command in robot.performed] == [Rest()]
    again = hall.presence("brain")
    again.settle()
    live(1.0, again)
    assert guard.follows == again.session
    assert [event.name for event in noticed] == ["brain.lost"]
    assert noticed[0].data["seconds"] == pytest.approx(6.0, abs=0.6)
    again.close()
    live(6.0)
    assert [command for _, command in robot.performed] == [Rest(), Rest()]


def test_a_robot_rests_each_time_that_the_same_brain_is_gone(hall: Hall) -> None:
    robot, presence, brain = RecordingRobot(BODY), hall.presence("robot"), hall.presence("brain")
    noticed: list[Event] = []
    guard = BrainGuard(robot, presence, noticed.append, lambda line: None, lambda: hall.time)
    for one in (presence, brain):
        one.settle()

    def live(seconds: float, *others: Presence) -> None:
        for _ in range(round(seconds / 0.1)):
            hall.live(0.1, presence, *others)
            robot.advance(0.1)
            guard.tick(hall.time)

    live(1.0, brain)
    for outage in range(1, 6):
        live(6.0)
        assert [command for _, command in robot.performed] == outage * [Rest()]
        brain._excuse(hall.time)  # it did not hear us either
        live(1.0, brain)
        assert guard.follows == brain.session
        assert [event.name for event in noticed] == outage * ["brain.lost"]
        assert noticed[-1].data["seconds"] == pytest.approx(6.0, abs=0.6)


def test_a_robot_that_stood_still_rests_first_and_then_follows_its_brain_on(hall: Hall) -> None:
    robot, presence, brain = RecordingRobot(BODY), hall.presence("robot"), hall.presence("brain")
    noticed: list[Event] = []
    told: list[str] = []
    guard = BrainGuard(robot, presence, noticed.append, told.append, lambda: hall.time)
    for one in (presence, brain):
        one.settle()

    def live(seconds: float, *others: Presence) -> None:
        for _ in range(round(seconds / 0.1)):
            hall.live(0.1, presence, brain, *others)
            guard.tick(hall.time)
            robot.advance(0.1)

    live(1.0)
    hall.live(8.0, brain)
    live(1.0)
    assert [command for _, command in robot.performed] == [Rest()]
    assert told[-1] == "rests: its process was paused for 8.1 s"
    assert (guard.follows, noticed) == (brain.session, [])
    other = hall.presence("robot")
    other.settle()
    with pytest.raises(BusError, match=r"was paused, and process \d+ on .* has replaced it: this process ends"):
        live(1.0, other)


def test_who_stood_still_has_lost_nobody_by_that(hall: Hall) -> None:
    brain, robot = hall.presence("brain"), hall.presence("robot")
    for one in (brain, robot):
        one.settle()
    hall.live(1.0, brain, robot)
    hall.time += 60.0
    assert hall.live(LOST_AFTER - 0.5, brain) == [[]]
    [lost] = hall.live(1.0, brain)
    assert [event.name for event in lost] == ["robot.lost"]
    assert lost[0].data["seconds"] == pytest.approx(LOST_AFTER, abs=0.6)


class Line:
    """A remote robot whose other end is this test."""

    def __init__(self, hall: Hall) -> None:
        self.hall = hall
        self.robot = RemoteRobot(PROJECT, hall.bus, lambda: hall.time, patience=lambda: hall.time)

    def report(self, id: str, state: str, **more: str) -> None:
        self.hall.bus.publish("avatar.NAO.event.command", {"id": f"{self.robot.session}.{id}", "state": state, **more})

    def live(self, seconds: float) -> list[Event]:
        events: list[Event] = []
        for _ in range(round(seconds / 0.1)):
            self.hall.time += 0.1
            events += self.robot.poll()
        return events

    def sent(self, key: str = "avatar.NAO.command") -> list[str]:
        return [body["method"] for body in self.hall.of(key)]


@pytest.fixture
def line(hall: Hall) -> Iterator[Line]:
    one = Line(hall)
    yield one
    one.robot.close()


def test_what_is_not_heard_of_is_sent_again_and_given_up_and_then_not_wanted(line: Line) -> None:
    line.robot.start("d1", Look(0.1, 0.0))
    assert line.live(4.5) == []
    assert line.sent() == ["look"] * 5
    assert len({body["id"] for body in line.hall.of("avatar.NAO.command")}) == 1
    [event] = line.live(1.0)
    assert (event.name, event.data) == ("error.command.d1", {"reason": "the robot does not answer"})
    line.report("d1", "started")
    assert line.live(0.2) == []
    assert line.sent()[-1] == "cancel"


def test_what_is_heard_of_lasts_and_is_asked_after(line: Line) -> None:
    line.robot.start("d1", Look(0.1, 0.0))
    line.report("d1", "accepted")
    assert line.live(60.0) == []
    assert line.sent() == ["look", *["outcome"] * 11]
    line.report("d1", "unknown")
    [event] = line.live(0.1)
    assert event.data == {"reason": "the robot has restarted and forgotten the command"}


def test_every_end_is_told_once_and_as_it_was(line: Line) -> None:
    for id in ("d1", "d2", "d3"):
        line.robot.start(id, Say("hello"))
    line.report("d1", "finished")
    line.report("d1", "finished")
    line.report("d2", "failed", reason="hoarse")
    line.report("d3", "cancelled")
    found = {event.name: event.data for event in line.live(0.1)}
    assert found == {
        "done.command.d1": None,
        "error.command.d2": {"reason": "hoarse"},
        "cancelled.command.d3": None,
    }


def test_what_comes_after_a_stop_waits_for_it_and_what_came_before_is_called_off(line: Line) -> None:
    line.robot.start("d1", Look(0.1, 0.0))
    line.robot.start("c2", Stop())
    line.robot.start("c3", Posture("Stand"))
    line.robot.start("c4", Look(0.2, 0.0))
    line.robot.cancel("c4")
    assert line.sent() == ["look", "cancel"]
    assert line.sent("avatar.NAO.stop") == ["stop"]
    assert [event.name for event in line.live(0.2)] == ["cancelled.command.c4"]
    line.report("c2", "accepted")
    line.live(0.1)
    assert line.sent() == ["look", "cancel", "goToPosture"]


def test_a_robot_that_is_lost_has_lost_what_it_did(line: Line) -> None:
    line.robot.start("d1", Look(0.1, 0.0))
    line.robot.start("c2", Rest())
    line.robot.lose("gone")
    assert [(e.name, e.data) for e in line.live(0.1)] == [
        ("lost.command.d1", {"reason": "gone"}),
        ("lost.command.c2", {"reason": "gone"}),
    ]


def test_commands_of_the_brain_before_are_answered_as_our_own(line: Line) -> None:
    line.robot.recover("old", ["d7", "d8"])
    assert [body["parameter"] for body in line.hall.of("avatar.NAO.command")] == [{"id": "old.d7"}, {"id": "old.d8"}]
    line.hall.bus.publish("avatar.NAO.event.command", {"id": "old.d7", "state": "started"})
    line.hall.bus.publish("avatar.NAO.event.command", {"id": "old.d8", "state": "finished"})
    assert [event.name for event in line.live(0.1)] == ["done.command.d8"]


def test_the_motion_module_does_what_it_can_and_the_brain_the_rest(line: Line) -> None:
    bus: Bus = line.hall.bus
    able = [""]

    class Own:
        on: tuple[str, ...] = ()
        ticks = 0

        def reload(self, project: Any) -> None: ...

        def switch(self, track: Track) -> None:
            self.on = (track.controller,) if track.on else ()

        def tick(self, now: float) -> None:
            self.ticks += 1

    own = Own()
    controllers = {"head": SimpleNamespace(output_bindings=("yaw",))}
    here = project(messages=messages(), controllers=controllers)
    shared = DelegatedTracking(own, here, bus, lambda: able[0], lambda: 1.0)  # type: ignore[arg-type]
    shared.switch(Track("head"))
    shared.tick(0.0)
    assert (own.on, own.ticks, shared.play("d1", Perform(here.motions["dance"]))) == (("head",), 1, False)
    able[0] = "there"
    shared.tick(0.0)
    assert (own.on, own.ticks, shared.on) == ((), 1, ("head",))
    assert shared.play("d1", Perform(here.motions["dance"]))
    assert not shared.play("d2", Perform(PROJECT.motions["dance"])), "a motion of other files"
    asked = [{k: v for k, v in body.items() if k != "bundle"} for body in line.hall.of("lumen.motion.NAO.command")]
    assert asked == [{"track": "head", "on": True}, {"id": "d1", "play": "dance"}]
    able[0] = ""
    shared.tick(0.0)
    assert (own.on, own.ticks) == (("head",), 2)


def test_aims_are_sent_and_readings_come(line: Line) -> None:
    line.robot.start("", Aim({"HeadYaw": 0.2}))
    assert line.hall.of("avatar.NAO.aim")[0]["parameter"] == {"jointNames": ["HeadYaw"], "angles": [0.2], "speed": 0.3}
    for body in ({"name": ["HeadYaw"], "angle": [0.0], "stiffness": [1.0]}, None, {"name": 3}, {"time": "late"}):
        line.hall.bus.publish("avatar.NAO.data.joint", body)
    assert line.robot.time() is None
    names = list(JOINTS)
    zeros = [0.0] * len(names)
    line.hall.bus.publish("avatar.NAO.data.joint", {"name": names, "angle": zeros, "stiffness": zeros, "time": 7.0})
    line.hall.time += 0.5
    assert line.robot.time() == pytest.approx(7.5)


def test_controllers_are_off_once_the_brain_is_gone(hall: Hall) -> None:
    shipped, clock = lumen.load(shipped_root()), SimpleNamespace(now=lambda: hall.time)
    own, brain, robot = (hall.presence(name) for name in ("motion", "brain", "robot"))
    for one in (own, brain, robot):
        one.settle()
    bus, narrator = validated(hall.bus, shipped), Printed(clock.now, lambda: shipped.machine)
    part = MotionPart(shipped, bus, clock, own, narrator)
    part.begin(0.0)
    hall.live(1.0, own, brain, robot)
    bus.publish(motion_key(shipped), {"track": "head", "on": True})
    part.tick(hall.time, ())
    assert part.quiet_until(0.0) == 0.0
    hall.live(LOST_AFTER - 2.0, own, robot)
    part.tick(hall.time, ())
    assert part.quiet_until(0.0) == 0.0
    hall.live(LOST_AFTER, own, robot)
    part.tick(hall.time, ())
    assert part.quiet_until(0.0) == inf
    part.close()
