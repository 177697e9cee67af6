"""Robots that are not there, too old, or gone in the middle of a motion."""

import logging
import sys
import time

import pytest

from lumen.errors import RobotError, RobotLostError
from lumen.features.naoqi.offers import NaoqiRobot
from lumen.features.naoqi.preparing import OPTIONAL_SERVICES, _protect
from lumen.features.naoqi.session import address
from lumen.language.commands import Say
from lumen.language.projects import Project
from lumen.ports import Perform, Sense
from tests.features.naoqi.conftest import Live
from tests.features.naoqi.fake import FakeNao
from tests.features.naoqi.lockstep import Lockstep
from tests.tables import for_each
from tests.waiting import until


def connected(project: Project, url: str) -> NaoqiRobot:
    return NaoqiRobot(project.body, url, time.monotonic)


def test_without_qi_the_error_says_how_to_get_it(project: Project, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "qi", None)
    with pytest.raises(RobotError, match=r"pip install 'lumen-robot\[naoqi\]'"):
        connected(project, "nao.local")


@pytest.mark.parametrize(
    ("url", "whole"),
    [
        ("nao.local", "tcp://nao.local:9559"),
        ("tcp://10.0.0.7", "tcp://10.0.0.7:9559"),
        ("tcp://nao.local:9503", "tcp://nao.local:9503"),
        (" tcps://nao.local:9503 ", "tcps://nao.local:9503"),
    ],
)
def test_addresses(url: str, whole: str) -> None:
    assert address(url) == whole


@for_each("url", ["", "tcp://", "http://nao.local:80", "tcp://nao.local:port", "tcp://:9559"])
def test_what_is_no_address(url: str) -> None:
    with pytest.raises(RobotError, match=r"write tcp://nao\.local:9559"):
        address(url)


@pytest.mark.parametrize("url", ["tcp://127.0.0.1:1", "tcp://robot.invalid"])
def test_no_robot_there_is_one_line(project: Project, url: str) -> None:
    with pytest.raises(RobotError, match="switched on") as error:
        connected(project, url)
    assert "\n" not in str(error.value)


def test_an_old_naoqi_is_refused(project: Project) -> None:
    nao = FakeNao(project.body, version="1.14.5")
    with pytest.raises(RobotError, match=r"NAOqi 1\.14\.5: Lumen needs 2\.1"):
        connected(project, nao.url)
    nao.close()


def test_what_is_no_nao_is_refused(project: Project) -> None:
    nao = FakeNao(project.body, without=["ALRobotPosture"])
    with pytest.raises(RobotError, match="there is no ALRobotPosture"):
        connected(project, nao.url)
    nao.close()


def test_services_that_are_missing_are_told_and_gone_without(
    project: Project, caplog: pytest.LogCaptureFixture
) -> None:
    with caplog.at_level(logging.WARNING):
        robot = Lockstep(project, FakeNao(project.body, without=["ALTextToSpeech", "ALSonar", "ALVideoDevice"]))
        robot.start("a", Say("Hello", "en"))
        robot.start("b", Perform(project.motions["photo"]))
        events = []
        for _ in range(50):
            robot.advance(0.02)
            events += robot.poll()
    lines = [record.getMessage() for record in caplog.records]
    robot.close()
    assert [(e.name, e.data) for e in events] == [("error.command.a", {"reason": "this robot has no ALTextToSpeech"})]
    assert any("no ALSonar: only its bumpers" in line for line in lines)
    assert any("sense `image` is not available" in line for line in lines)


@pytest.mark.slow
def test_a_connection_lost_in_a_motion_fails_it_and_comes_back(
    robot: Lockstep, live: Live, project: Project, caplog: pytest.LogCaptureFixture
) -> None:
    robot.start("dance", Perform(project.motions["dance"]))
    live(2.0)
    port = robot.nao.port
    with caplog.at_level(logging.WARNING):
        robot.nao.drop()
        until(lambda: robot._reconnector._changes)
        lost = live(0.1)
        assert {event.name for event in lost} == {"robot.lost", "error.command.dance"}
        assert ["robot is lost" in str(event.data) for event in lost if event.name != "robot.lost"] == [True]
        robot.start("b", Say("Hello", "en"))
        assert [event.data for event in live(0.1)] == [{"reason": "the connection to the robot is lost"}]
        robot.nao.world.life = "interactive"
        robot.nao.times.run()
        robot.nao.open(port)
        until(lambda: robot._session.up and robot._reconnector._changes)
    assert [event.name for event in robot.poll()] == ["robot.back"]
    world = robot.nao.world
    assert world.called("setState") == [("disabled",), ("disabled",)]
    assert world.called("killTasksUsingResources") == [(list(project.body.joints),)]
    assert world.called("stopMove") == [()]
    assert sum("the robot is lost" in record.getMessage() for record in caplog.records) == 1


def test_a_robot_that_is_lost_while_it_is_taken_over_is_no_robot_without_services(
    robot: Lockstep, caplog: pytest.LogCaptureFixture
) -> None:
    """Each method ends at the first lost call, and does not report what the robot lacks."""
    session = robot._session
    session.close()
    sensors = robot._senses[Sense.JOINT]
    with caplog.at_level(logging.WARNING):
        for prepared in (
            lambda: robot._naoqi_events.listen(session),
            lambda: _protect(session),
            lambda: session.find(OPTIONAL_SERVICES),
            sensors._acquire,
        ):
            with pytest.raises(RobotLostError, match="the connection to the robot is lost"):
                prepared()
    assert not caplog.records


def test_a_robot_that_is_silent_is_lost(robot: Lockstep, live: Live) -> None:
    """A pulled cable sends no message, so a silent robot counts as lost."""
    robot._session._broken(robot._session._session, "the robot has not answered for 2 s")
    assert live(0.1)[0].name == "robot.lost"
