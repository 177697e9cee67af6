"""Commands with an id of their own: reported on, performed once, asked after, called off, overtaken."""

import time
from collections.abc import Callable
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest

from lumen.bus import connect
from lumen.bus.memory import MemoryBus
from lumen.bus.validated import validated
from lumen.clock.simulated import SimulatedClock
from lumen.language.commands import Look, Rest, Say, Wake
from lumen.ports import MessageHandler, Perform
from lumen.robot.command_receiver import ID_TAKEN
from lumen.robot.deduplication_log import DEDUPLICATION_WINDOW, DeduplicationLog
from lumen.robot.recording import RecordingRobot
from lumen.robot.remote import RobotHost
from lumen.run.narrator import Narrator
from lumen.run.parts.hosted_robot import HostedRobotPart
from lumen.run.presence import Presence
from lumen.run.setup import Setup
from tests.exhibits import BODY, messages, project
from tests.server.stand import delivered
from tests.waiting import Collector

PROJECT = project(messages=messages())


class Desk:
    """A hosted recording robot, and a module that receives the reports on its commands."""

    def __init__(self) -> None:
        self.robot, self.bus = RecordingRobot(BODY), validated(connect("memory://"), PROJECT)
        self.host = RobotHost(PROJECT, self.robot, self.bus, self.robot)
        self.reports, self.answers, self.noticed, self.texts = Collector(), Collector(), Collector(), Collector()
        self.bus.subscribe("avatar.NAO.event.command", self.reports)
        self.bus.subscribe("avatar.NAO.event.noticed", self.noticed)
        self.bus.subscribe("lumen.me", self.answers)

    def order(self, id: str, method: str, key: str = "command", /, **more: Any) -> None:
        top = {name: more.pop(name) for name in ("replace",) if name in more}
        body = {"type": "motion", "method": method, "parameter": more, **top, **({"id": id} if id else {})}
        self.publish(f"avatar.NAO.{key}", body, reply_to="lumen.me", correlation_id="c")

    def publish(self, key: str, body: Any, **options: Any) -> None:
        """Publish a message, and wait until it has arrived."""
        self.bus.publish(key, body, **options)
        delivered(self.bus._bus)

    def live(self, seconds: float) -> None:
        for _ in range(round(seconds / 0.02)):
            self.robot.advance(0.02)
            self.host.tick(self.robot.time)
        delivered(self.bus._bus)

    def states(self, id: str) -> list[str]:
        return [body["state"] for body in self.reports.bodies if body["id"] == id]

    @property
    def began(self) -> list[Any]:
        return [command for _, command in self.robot.performed]


@pytest.fixture
def desk() -> Any:
    one = Desk()
    yield one
    one.host.close()


def test_a_command_is_accepted_started_and_finished(desk: Desk) -> None:
    desk.order("a", "goodbye")
    desk.live(2.0)
    assert desk.states("a") == ["accepted", "started", "finished"]
    assert [body["state"] for body in desk.answers.bodies] == ["accepted", "started", "finished"]


def test_one_that_waits_for_its_parts_has_not_started(desk: Desk) -> None:
    desk.order("a", "say", text="x" * 20)
    desk.order("b", "say", text="y")
    desk.live(1.0)
    assert (desk.states("a"), desk.states("b")) == (["accepted", "started"], ["accepted"])
    desk.live(2.0)
    assert desk.states("b") == ["accepted", "started", "finished"]


def test_a_module_of_2015_hears_its_text_alone_and_who_watches_hears_all(desk: Desk) -> None:
    body = {"type": "motion", "Method": "moveTo", "parameter": {"x": 0.2, "y": 0, "tetha": 0}}
    desk.publish("avatar.NAO.command", body, reply_to="lumen.me", correlation_id="7")
    desk.live(3.0)
    assert desk.answers.bodies == ["command finished"]
    assert desk.states("7") == ["accepted", "started", "finished"]


def test_what_comes_again_is_told_how_it_stands_and_not_performed_again(desk: Desk) -> None:
    desk.order("a", "goodbye")
    desk.live(0.2)
    desk.order("a", "goodbye")
    desk.live(2.0)
    desk.order("a", "goodbye")
    desk.order("a", "dance")
    desk.live(0.2)
    assert len(desk.began) == 1
    assert desk.states("a") == ["accepted", "started", "started", "finished", "finished"]
    assert desk.answers.bodies[-1] == {"id": "a", "state": "failed", "method": "dance", "reason": ID_TAKEN}


def test_a_refusal_is_the_outcome_too(desk: Desk) -> None:
    for _ in range(2):
        desk.order("a", "danse")
        desk.live(0.1)
    assert desk.states("a") == ["failed", "failed"]
    assert desk.reports.bodies[1]["reason"] == "there is no method `danse`: did you mean `dance`?"


def test_a_command_is_called_off_before_it_comes_while_it_lasts_and_not_afterwards(desk: Desk) -> None:
    desk.order("", "cancel", id="late")
    desk.order("late", "dance")
    desk.order("a", "sing")
    desk.live(0.2)
    desk.order("", "cancel", id="a")
    desk.live(0.2)
    desk.order("", "cancel", id="a")
    desk.live(0.2)
    assert [command.motion.name for command in desk.began] == ["sing"]
    assert desk.states("late") == ["cancelled", "cancelled"]
    assert desk.states("a") == ["accepted", "started", "started", "cancelled", "cancelled"]


def test_who_asks_is_told_the_outcome_and_that_nobody_knows_it(desk: Desk) -> None:
    desk.order("a", "goodbye")
    desk.live(2.0)
    for id in ("a", "b"):
        desk.order("", "outcome", id=id)
    desk.order("", "outcome")
    desk.live(0.1)
    assert (desk.states("a")[-1], desk.states("b")) == ("finished", ["unknown"])
    assert desk.answers.bodies[-1] == "command failed: pass the `id` of the command"


@pytest.mark.parametrize(("key", "method"), [("stop", "rest"), ("command", "stopMove"), ("stop", "stop")])
def test_what_stops_overtakes_what_came_before_it_and_nothing_after(desk: Desk, key: str, method: str) -> None:
    desk.order("a", "dance")
    desk.order("b", "say", text="hello")
    desk.order("s", method, key)
    desk.order("c", "look", yaw=0.1)
    desk.live(4.0)
    assert desk.states("a") == desk.states("b") == ["cancelled"]
    assert desk.states("s")[-1] == "finished"
    assert desk.states("c")[-1] == ("failed" if method == "rest" else "finished"), "a robot that rests does not move"
    assert not any(isinstance(command, Perform | Say) for command in desk.began)
    assert isinstance(desk.began[-1], Rest if method == "rest" else Look)


def test_a_stop_of_one_kind_leaves_the_others(desk: Desk) -> None:
    desk.order("a", "dance")
    desk.order("b", "say", text="x" * 10)
    desk.live(0.1)
    desk.order("s", "stop", what="play")
    desk.order("e", "stop", what="everything")
    desk.live(2.0)
    assert desk.states("a")[-1] == "cancelled"
    assert (desk.states("b")[-1], desk.states("e")) == ("finished", ["failed"])


def test_a_command_that_replaces_does_not_wait(desk: Desk) -> None:
    desk.order("a", "say", text="x" * 200)
    desk.live(0.2)
    desk.order("b", "say", text="y", replace=True)
    desk.live(1.0)
    assert desk.states("a")[-1] == "cancelled"
    assert desk.states("b")[-1] == "finished"


def test_what_the_robot_notices_is_told_to_everybody(desk: Desk) -> None:
    desk.robot.touch("FrontTactil", True)
    desk.live(0.1)
    [body] = desk.noticed.bodies
    assert (body["name"], body["data"]) == ("touched", {"sensor": "FrontTactil"})


def test_what_a_visitor_does_and_what_makes_no_sense(desk: Desk, caplog: pytest.LogCaptureFixture) -> None:
    deeds: list[Any] = [
        {"sensor": "RearTactil", "pressed": True}, {"event": "fallen", "data": {}}, {"event": "robot.exploded"},
        {"sensor": "Nose", "pressed": True}, {"visitor": {"x": "near"}}, {"visitor": {"x": 1e9, "y": 0, "height": 1}},
        ["visitor"], None, 7,
    ]  # fmt: skip
    for deed in deeds:
        desk.publish("avatar.NAO.hall", deed)
    desk.live(0.1)
    assert [body["name"] for body in desk.noticed.bodies] == ["touched", "fallen"]
    assert len(caplog.records) == 7


@pytest.mark.parametrize("body", [None, 7, [], {}, {"method": 7}, {"id": 5, "method": "rest"}, {"parameter": []}])
def test_no_body_ends_the_server(desk: Desk, body: Any) -> None:
    desk.bus._bus.publish("avatar.NAO.stop", body)
    desk.bus._bus.publish("avatar.NAO.aim", body)
    desk.bus._bus.publish("avatar.NAO.command", {"method": "wakeUp"})
    delivered(desk.bus._bus)
    desk.live(3.0)
    assert Wake() in desk.began


def test_many_ids_are_remembered_and_not_all(desk: Desk) -> None:
    for i in range(1_200):
        desk.order(f"n{i}", "setLanguage", language="id")
        if i % 50 == 0:
            desk.live(0.02)
    desk.live(0.1)
    known = desk.host.server._orders._reports._known
    assert len(known) == 1_000
    assert "n1199" in {id for _, id in known}


def test_a_robot_that_was_restarted_does_nothing_twice_but_rest(tmp_path: Path) -> None:
    ends = []
    for _ in range(2):
        desk = Desk()
        desk.host.server.recall(DeduplicationLog(tmp_path / "home" / "commands"))
        desk.order("a", "goodbye")
        desk.live(0.1)
        desk.order("b", "rest")
        desk.live(3.0)
        ends.append((desk.states("a")[-1], desk.states("b")[-1]))
        desk.host.close()
    assert ends == [("cancelled", "finished"), ("failed", "finished")]
    assert desk.reports.bodies[0]["reason"] == "the robot has restarted since it began that command"


def test_a_ledger_keeps_the_newest_and_a_line_that_was_cut_short_harms_nobody(tmp_path: Path) -> None:
    file = tmp_path / "commands"
    ledger = DeduplicationLog(file)
    for i in range(2_500):
        ledger.note(f"n\n{i}", "desk")
    assert len(file.read_bytes().splitlines()) <= 2_000
    with file.open("ab") as end:
        end.write(b'"n\xff')
    assert DeduplicationLog(file).before[-1][1:] == ("n\n2499", "desk")
    assert len(DeduplicationLog(file).before) >= 999


def test_what_was_begun_long_before_a_restart_may_come_again(tmp_path: Path) -> None:
    file = tmp_path / "commands"
    file.write_text(f'[{time.time() - DEDUPLICATION_WINDOW - 1}, "1"]\n[{time.time() - 5}, "2"]\n"3"\n', "utf-8")
    assert [command[1:] for command in DeduplicationLog(file).before] == [("2", None)]


def test_a_disk_that_takes_nothing_is_told_of_once(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    (tmp_path / "home").write_text("a file, and no folder")
    ledger = DeduplicationLog(tmp_path / "home" / "commands")
    for id in ("a", "b"):
        ledger.note(id, "desk")
    assert [record.getMessage().count("cannot be written to") for record in caplog.records] == [1]


class EagerBus(MemoryBus):
    """A bus that delivers a stop and a command, each with an id, as soon as their keys have a subscriber."""

    def subscribe(self, pattern: str, handler: MessageHandler) -> Callable[[], None]:
        undo = super().subscribe(pattern, handler)
        for key, id, method in (("stop", "s.1", "rest"), ("command", "c.1", "wakeUp")):
            if pattern == f"avatar.NAO.{key}":
                self.publish(pattern, {"type": "motion", "method": method, "parameter": {"by": "Ada"}, "id": id})
        return undo


def test_what_arrives_while_the_robot_is_made_is_not_lost(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    it = project(messages=messages(), root=str(tmp_path))
    robot, bus = RecordingRobot(BODY), validated(EagerBus(), it)
    setup = Setup(robot, SimulatedClock(robot.advance), robot)
    narrator = Narrator(lambda: 0.0, lambda: it.machine)
    part = HostedRobotPart(it, bus, setup, Presence(bus, "NAO", ("robot",)), narrator)
    with closing(part):
        part.begin(0.0)
        part.tick(0.0, ())
        robot.advance(0.02)
        assert part.stopped()
        assert [command for _, command in robot.performed] == [Rest(by="Ada")]
        assert not caplog.records
