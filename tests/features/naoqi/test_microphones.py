"""WAV recordings from the robot's microphones, and the faults that can prevent one."""

import base64
import io
import logging
import wave

import pytest

from lumen.language.events import RECORDED, Event
from lumen.language.projects import Project
from lumen.ports import Record
from tests.features.naoqi.conftest import Live
from tests.features.naoqi.fake import FakeNao
from tests.features.naoqi.lockstep import Lockstep


def recorded(events: list[Event]) -> tuple[str, tuple[int, int, int], bytes]:
    """Return the name of the only recording, its channels, bytes per sample and rate [Hz], and its samples."""
    [data] = [event.data for event in events if event.name == RECORDED]
    with wave.open(io.BytesIO(base64.b64decode(data["content"]))) as file:
        kind = file.getnchannels(), file.getsampwidth(), file.getframerate()
        return data["name"], kind, file.readframes(10**6)


def reasons(events: list[Event]) -> list[str]:
    return [event.data["reason"] for event in events if event.name.startswith("error.")]


def test_a_recording_is_what_the_front_microphone_heard(robot: Lockstep, live: Live) -> None:
    robot.start("a", Record("r1", 1.0))
    events = live(2.0)
    assert [event.name for event in events] == [RECORDED, "done.command.a"]
    assert recorded(events) == ("r1", (1, 2, 16_000), robot.nao.world.sound[:32_000])
    assert robot.nao.world.called("setClientPreferences") == [("LumenMicrophones", 16_000, 3, 0)]
    assert not robot.nao.microphones.subscribers


def test_one_recording_after_the_other_and_each_from_its_beginning(robot: Lockstep, live: Live) -> None:
    robot.start("a", Record("r1", 0.5))
    robot.start("b", Record("r2", 0.3))
    first, done, second, also = live(3.0)
    assert (done.name, also.name) == ("done.command.a", "done.command.b")
    assert recorded([first])[2] == robot.nao.world.sound[:16_000]
    assert recorded([second])[2] == robot.nao.world.sound[:9_600]


def test_a_cancelled_recording_is_none_and_lets_go_of_the_microphones(robot: Lockstep, live: Live) -> None:
    robot.start("a", Record("r1", 5.0))
    live(1.0)
    assert list(robot.nao.microphones.subscribers) == ["LumenMicrophones"]
    robot.cancel("a")
    assert [event.name for event in live(1.0)] == ["cancelled.command.a"]
    assert not robot.nao.microphones.subscribers


def test_microphones_that_nothing_comes_from(robot: Lockstep, live: Live) -> None:
    """A firewall lets us reach the robot, and not the robot reach us."""
    robot.nao.world.listens = False
    robot.start("a", Record("r1", 1.0))
    [reason] = reasons(live(5.0))
    assert reason.startswith("0.0 of 1 s came from the microphones: check that the robot can reach this machine")
    assert not robot.nao.microphones.subscribers


def test_a_robot_without_microphones_says_so(project: Project, caplog: pytest.LogCaptureFixture) -> None:
    with caplog.at_level(logging.WARNING):
        robot = Lockstep(project, FakeNao(project.body, without=["ALAudioDevice"]))
        robot.start("a", Record("r1", 1.0))
        robot.advance(0.1)
        events = list(robot.poll())
    robot.close()
    assert reasons(events) == ["this robot has no ALAudioDevice"]
    assert "this robot has no ALAudioDevice: its microphones hear nothing" in caplog.text


def test_a_connection_lost_in_a_recording_fails_it(robot: Lockstep, live: Live) -> None:
    robot.start("a", Record("r1", 5.0))
    live(1.0)
    robot._session._broken(robot._session._session, "the robot has not answered for 2 s")
    assert reasons(live(0.1)) == ["the connection to the robot is lost: the robot has not answered for 2 s"]
