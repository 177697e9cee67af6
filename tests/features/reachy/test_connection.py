"""Reachy Mini's daemon goes away, comes back, and moves the robot for others."""

from typing import NoReturn

import pytest

from lumen.errors import RobotLostError
from lumen.features.reachy import link
from lumen.language.commands import Look, Rest, Say, Wake
from lumen.language.projects import Project
from lumen.ports import Live, Perform
from tests.features.reachy.driving import Driven
from tests.features.reachy.fake import ASLEEP, INIT, FakeDaemon
from tests.waiting import HANG

patient = pytest.mark.usefixtures("patient")
SILENCE = link.SILENCE


@patient
def test_a_daemon_killed_in_a_dance_is_lost_and_the_robot_woken_when_it_is_back(project: Project) -> None:
    daemon = FakeDaemon()
    robot = Driven(project, daemon.url)
    robot.answer("w", Wake())
    robot.robot.start("d", Perform(project.motions["dance"]))
    robot.until(lambda: abs(daemon.joints["head_roll"]) > 0.1, "it dances")
    daemon.close()
    robot.until(lambda: "robot.lost" in robot.names(), "it is lost")
    assert "the connection to the robot is lost" in robot.answer("d").data["reason"]
    assert "is lost" in robot.answer("l", Look(0.2)).data["reason"]
    again = FakeDaemon(daemon.port)
    robot.until(lambda: "robot.back" in robot.names(), "it is back")
    assert not [path for path, _ in again.asked if "stop" in path]
    assert again.joints == pytest.approx(INIT, abs=0.02)
    assert robot.answer("d2", Look(0.3)).name == "done.command.d2"
    assert not [name for name in robot.names() if "reachy" in name]
    robot.close()
    again.close()


@patient
def test_a_robot_that_slept_or_was_sent_to_sleep_is_not_woken(project: Project) -> None:
    daemon = FakeDaemon()
    robot = Driven(project, daemon.url)
    robot.answer("w", Wake())
    daemon.close()
    robot.until(lambda: "robot.lost" in robot.names(), "it is lost")
    assert robot.answer("r", Rest()).name == "error.command.r"
    again = FakeDaemon(daemon.port)
    robot.until(lambda: "robot.back" in robot.names(), "it is back")
    assert again.joints == ASLEEP
    assert "/api/move/play/wake_up" not in [path for path, _ in again.asked]
    robot.close()
    again.close()


@patient
def test_a_socket_that_stays_open_and_silent_is_noticed(
    awake: Driven, daemon: FakeDaemon, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(link, "SILENCE", SILENCE)
    last = awake.robot._link.measured.at
    awake.until(lambda: awake.robot._link.measured.at != last, "a wait that began with the longer limit has ended")
    daemon.silent = True
    awake.until(lambda: "robot.lost" in awake.names(), "it is lost")
    daemon.silent = False
    awake.until(lambda: "robot.back" in awake.names(), "it is back")


@patient
def test_a_move_of_the_daemon_is_reported_and_not_fought(awake: Driven, daemon: FakeDaemon, project: Project) -> None:
    awake.robot.start("", Live(project.life["lively"]))
    awake.robot.start("d", Perform(project.motions["dance"]))
    awake.tick()
    move = daemon.move({**INIT, "head_yaw": 1.0}, duration=HANG)
    assert "another program moves the robot" in awake.answer("d").data["reason"]
    sent = len(awake.sent)
    assert "another program" in awake.answer("l", Look(0.3)).data["reason"]
    assert awake.answer("s", Say("Oh")).name == "done.command.s"
    assert len(awake.sent) == sent
    daemon.answer("POST", "/api/move/stop", {"uuid": move})
    awake.until(lambda: awake.robot._yields is False, "it goes on")
    taken, free = [event for event in awake.events if event.name in ("robot.busy", "robot.free")]
    assert "another program moves the robot" in taken.data["reason"]
    assert (taken.name, free.name, list(free.data)) == ("robot.busy", "robot.free", ["seconds"])
    assert awake.answer("l2", Look(0.3)).name == "done.command.l2"


@patient
def test_rest_ends_the_moves_of_others(awake: Driven, daemon: FakeDaemon) -> None:
    daemon.move({**INIT, "head_yaw": 1.0}, duration=HANG)
    assert awake.answer("r", Rest()).name == "done.command.r"
    awake.until(lambda: not daemon.moves, "it lies")
    assert daemon.joints == pytest.approx(ASLEEP, abs=0.01)


@patient
def test_another_program_that_streams_is_noticed_and_the_head_taken_up_where_it_left_it(
    awake: Driven, daemon: FakeDaemon, project: Project
) -> None:
    awake.robot.start("", Live(project.life["lively"]))
    awake.robot.start("d", Perform(project.motions["dance"]))
    awake.tick()
    daemon.held = {"head_yaw": 0.9}
    assert "something else moves the robot" in awake.answer("d").data["reason"]
    sent = len(awake.sent)
    awake.tick()
    assert len(awake.sent) == sent
    daemon.joints["head_yaw"], daemon.held = 0.9, None
    awake.until(lambda: len(awake.sent) > sent, "it goes on")
    assert awake.sent[sent]["head_yaw"] == pytest.approx(0.9, abs=0.2)


@patient
def test_a_second_wake_ends_the_tail_of_going_to_sleep(awake: Driven, daemon: FakeDaemon) -> None:
    awake.robot.start("r", Rest())
    awake.until(lambda: "/api/move/play/goto_sleep" in [path for path, _ in daemon.asked], "it goes to sleep")
    awake.robot.cancel("r")
    assert awake.answer("w", Wake()).name == "done.command.w"
    assert daemon.mode == "enabled"
    assert daemon.joints == pytest.approx(INIT, abs=0.02)


@patient
def test_two_robots_at_once(project: Project) -> None:
    daemons = FakeDaemon(), FakeDaemon()
    robots = [Driven(project, one.url) for one in daemons]
    for robot in robots:
        robot.robot.start("w", Wake())
    for robot in robots:
        assert robot.answer("w").name == "done.command.w"
    robots[0].answer("l", Look(0.5))
    assert daemons[0].joints["head_yaw"] == pytest.approx(0.5, abs=0.02)
    assert daemons[1].joints["head_yaw"] == pytest.approx(0.0, abs=0.02)
    for each in (*robots, *daemons):
        each.close()


def test_a_peer_that_speaks_first_is_an_answer_that_does_not_come(
    project: Project, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Then websockets raises an AssertionError, but only if the data arrives before its own request has left."""

    def connect(*arguments: object, **options: object) -> NoReturn:
        raise AssertionError

    daemon = FakeDaemon()
    monkeypatch.setattr("websockets.sync.client.connect", connect)
    with pytest.raises(RobotLostError, match="does not answer"):
        Driven(project, daemon.url)
    daemon.close()
