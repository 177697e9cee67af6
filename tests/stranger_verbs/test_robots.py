"""A verb of a package on robots: performed in a thread that no tick and no stop waits for, on each robot alike."""

import json
from collections.abc import Iterator
from typing import Any

import pytest

from lumen.bus.memory import MemoryBus
from lumen.errors import BadCommandError
from lumen.feature import resolve
from lumen.language.commands import Do, Posture, Rest, Say, Start, Stop, Wake
from lumen.language.events import RESULT, Event
from lumen.ports import RobotCommand
from lumen.robot.bounded_robot import BoundedRobot, is_idle
from lumen.robot.command_codec import decode_command, encode_command
from lumen.robot.command_table import parts_of, row_of
from lumen.robot.executor import Executor
from lumen.robot.person_hold import PersonHold
from lumen.robot.recording import RecordingRobot
from lumen.robot.remote import RemoteRobot
from lumen.robot.server import RobotServer
from lumen.robot.skill_runner import SkillRunner
from lumen.run.trace_publisher import TracePublisher
from lumen.run.trace_subscriber import TraceSubscriber
from tests.exhibits import BODY, project
from tests.robots.test_executor import Fake, names
from tests.seams.test_joints import NAO, Obedient
from tests.seams.test_verbs import Heard
from tests.tables import for_each
from tests.waiting import threads, until

BLINK = Do("blink", {"times": 3, "eye": "both"})


@pytest.fixture
def executor() -> Iterator[Executor]:
    """A robot's executor that runs performers."""
    runner = SkillRunner()
    yield Executor(lambda c, now: Fake(c, now, 0.0), lambda c: parts_of(c, BODY), runner.begin)
    runner.close()
    resolve("lumen_blinker.performers:STALLED").set()


def ends(executor: Executor, now: float = 0.0) -> list[Event]:
    """Advance the executor, which stays at `now` [s], until something ends; return the events."""
    events: list[Event] = []
    until(lambda: bool(events.extend(executor.advance(now)) or events))
    return events


def test_its_performer_waits_by_the_robots_clock_and_returns_a_result(executor: Executor) -> None:
    executor.start("d1", BLINK)
    assert executor.advance(0.0) == []
    assert (executor.owner("head"), executor.begun()) == ("d1", ["d1"])
    events: list[Event] = []
    clock = iter(range(1_000_000))
    until(lambda: bool(events.extend(executor.advance(next(clock) * 0.5)) or events))
    assert [(event.name, event.data) for event in events] == [("done.command.d1", {RESULT: {"blinked": 3}})]
    assert not executor.busy


@for_each(
    ("verb", "reason"),
    [
        ("break", "`break` failed: ZeroDivisionError('by zero')"),
        ("refuse", "the eyelids stick"),
        ("misreport", "`misreport` returned something wrong: `blinked` should be a whole number, not a text"),
        ("exit", "`exit` failed: SystemExit(3)"),
        ("count", "`count` returned 3: return an object with names and values"),
        ("spoil", "`spoil` returned something that is not JSON data: Object of type set is not JSON serializable"),
        ("vanish", "`vanish` failed: ModuleNotFoundError(\"No module named 'lumen_blinker.missing'\")"),
    ],
)
def test_a_fault_of_a_performer_costs_its_verb(executor: Executor, verb: str, reason: str) -> None:
    executor.start("d1", Do(verb))
    assert [(event.name, event.data) for event in ends(executor)] == [("error.command.d1", {"reason": reason})]


@for_each(
    ("command", "reason"),
    [
        (Do("blnk", {}), "no feature here has a verb `blnk`: did you mean `blink`?"),
        (Do("blink", {"times": 0}), "`blink`: `times` is 0, but should be at least 1 (How often)"),
    ],
)
def test_what_does_not_fit_its_row_is_refused(executor: Executor, command: Do, reason: str) -> None:
    executor.start("d1", command)
    ((name, data, *_),) = executor.advance(0.0)
    assert name == "error.command.d1"
    assert data["reason"].startswith(reason)


@pytest.mark.parametrize("stop", [Stop(), Rest()])
def test_nothing_that_stops_the_robot_waits_for_it(executor: Executor, stop: RobotCommand) -> None:
    executor.start("d1", Do("stall"))
    executor.start("d2", Do("wiggle"))
    executor.advance(0.0)
    calls = resolve("lumen_blinker.performers:CALLS")
    until(lambda: any(call.skill == "stall" for call in calls))
    executor.start("stop", stop)
    assert names(executor.advance(0.0))[:2] == ["cancelled.command.d1", "cancelled.command.d2"]
    assert executor.owner("arms") in ("stop", "")
    executor.start("d3", Do("stall"))
    (refused,) = [event for event in executor.advance(3.0) if event.name.startswith("error")]
    assert refused.data == {"reason": "`stall` was cancelled and has not ended yet: try again later"}


@for_each(("verb", "cancelled"), [("wiggle", True), ("hum", False)])
def test_a_cancel_reaches_the_performer_unless_its_row_forbids_that(
    executor: Executor, verb: str, cancelled: bool
) -> None:
    calls = resolve("lumen_blinker.performers:CALLS")
    executor.start("d1", Do(verb))
    executor.advance(0.0)
    until(lambda: any(call.skill == verb for call in calls))
    executor.cancel("d1")
    assert names(executor.advance(0.0)) == ["cancelled.command.d1"]
    (call,) = [call for call in calls if call.skill == verb]
    assert call.cancelled is cancelled


def test_one_that_moves_the_robot_is_refused_while_it_rests(executor: Executor) -> None:
    def refused() -> bool:
        executor.start("wiggle", Do("wiggle"))
        answers = names(executor.advance(9.0))
        executor.cancel("wiggle")
        executor.advance(9.0)
        until(lambda: not threads("lumen-skill-wiggle"))
        return "error.command.wiggle" in answers

    for ends, rests in ((Rest(), True), (Wake(), False), (Rest(), True), (Posture("Stand"), False)):
        executor.start("c1", ends)
        executor.advance(0.0)
        executor.advance(9.0)
        assert refused() is rests
    executor.fail("the robot fell", fallen=True)
    assert refused()


def test_a_person_who_stopped_the_robot_holds_one_that_moves_it() -> None:
    hold = PersonHold()
    hold.stop("Ada")
    assert hold.admit(Do("wiggle"), behavior=True).startswith("Ada stopped the robot")
    assert hold.admit(BLINK, behavior=True) == ""


@for_each(
    ("behaves", "expected"),
    [
        ({}, {1.0: [], 1.5: [("done.command.d1", {RESULT: {"blinked": 2}})]}),
        ({"blink": 0.5}, {0.5: [("done.command.d1", {RESULT: {"blinked": 2}})]}),
        ({"blink": "hangs"}, {99.0: []}),
        ({"blink": "fails"}, {0.0: [("error.command.d1", {"reason": "blink fails in this story"})]}),
    ],
)
def test_the_recording_robot_takes_its_time(behaves: dict[str, Any], expected: dict[float, Any]) -> None:
    robot = RecordingRobot(BODY, behaves)
    robot.start("d1", BLINK)
    robot.advance(0.0)
    for time, events in expected.items():
        robot.advance(time - robot.time)
        assert [(event.name, event.data) for event in robot.poll()] == events
    assert robot.performed == [(0.0, BLINK)]


@for_each("command", [BLINK, Do("wiggle")])
def test_it_crosses_the_bus(command: Do) -> None:
    assert decode_command(json.loads(json.dumps(encode_command(command))), project()) == command


def test_a_message_may_leave_out_what_has_a_default() -> None:
    body = {"type": "skill", "method": "do", "parameter": {"skill": "blink", "arguments": {"times": 3}}}
    assert decode_command(body, project()) == BLINK


@for_each(
    ("parameter", "reason"),
    [
        ({"skill": "blnk"}, "no feature here has a verb `blnk`"),
        ({"skill": "blink", "arguments": {"times": "x"}}, "`blink`: `times` should be a whole number, not a text"),
        ({"skill": "blink", "arguments": 3}, "the `arguments` of `do` must be an object with names and values"),
        ({}, "the parameter `skill` of `do` must be a string"),
    ],
)
def test_a_message_that_does_not_fit_is_refused(parameter: dict[str, Any], reason: str) -> None:
    with pytest.raises(BadCommandError) as raised:
        decode_command({"type": "skill", "method": "do", "parameter": parameter}, project())
    assert str(raised.value).startswith(reason)


def test_its_row_is_that_of_its_manifest() -> None:
    row = row_of(Do("wiggle"))
    assert (row.verb, row.moves, row.duration(Do("wiggle"))) == ("wiggle", True, 2.0)
    assert row.parts(Do("wiggle"), BODY) == {"head", "arms"}
    assert row_of(Say("x")).verb == "say"


def test_its_result_comes_back_from_a_robot_in_another_process() -> None:
    exhibit, bus, robot = project(), MemoryBus(), RecordingRobot(BODY)
    server = RobotServer(exhibit, robot, bus, direct=True)
    remote = RemoteRobot(exhibit, bus, lambda: robot.time, patience=lambda: robot.time)
    remote.start("d1", BLINK)
    events: list[Event] = []
    for _ in range(20):
        server.sample(robot.time)
        robot.advance(0.1)
        for event in robot.poll():
            server.answer(event)
        events += remote.poll()
    assert remote.begun() == ["d1"]
    assert [(event.name, event.data) for event in events] == [("done.command.d1", {RESULT: {"blinked": 2}})]
    server.close()


def test_a_robot_of_ones_own_performs_it_without_knowing_it() -> None:
    own = Obedient()
    robot = BoundedRobot(own, NAO)
    robot.start("d1", Do("wiggle"))
    assert [*robot.poll(), *robot.begun()] == ["d1"]
    assert not is_idle(robot)
    robot.start("stop", Stop())
    assert names([*robot.poll(), *robot.poll()]) == ["cancelled.command.d1", "done.command.stop"]
    robot.start("rest", Rest())
    robot.poll()
    robot.start("d2", Do("wiggle"))
    until(lambda: (events := robot.poll()) and events[0].data)
    assert [type(command) for _, command in own.told] == [Stop, Rest]
    robot.close()


def test_one_that_performs_verbs_itself_is_given_them() -> None:
    own = RecordingRobot(NAO)
    BoundedRobot(own, NAO).start("d1", BLINK)
    own.advance(0.0)
    assert own.performed == [(0.0, BLINK)]


def test_whoever_watches_from_another_process_sees_it() -> None:
    exhibit, bus, heard = project(), MemoryBus(), Heard()
    subscriber = TraceSubscriber(exhibit, bus, lambda _: None)
    subscriber.watchers.append(heard)
    TracePublisher(bus, lambda: exhibit, lambda: 0.0).performing(Start("d1", BLINK), 0.0)
    subscriber.tick(0.0)
    assert heard.commands == [Start("d1", BLINK)]
