"""The duet: two NAOs in one physics world speak in turns and dance in step; what one sends, the other hears."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import lumen
from lumen.cli.main import main
from lumen.lint import check
from lumen.ports import Bus, Message
from lumen.run.exhibition import Exhibition
from lumen.run.house import House
from lumen.run.plan import Plan
from lumen.run.setup import set_up_house
from tests import ROOT
from tests.copying import copied_project
from tests.waiting import Collector

DUET = ROOT / "examples/duet"
NAMES = ("ana", "ben")
ARM = "RShoulderPitch"


@pytest.fixture
def heard() -> Iterator[Bus]:
    bus = lumen.bus.connect("memory://duet")
    yield bus
    bus.close()


def duet(kind: str) -> tuple[House, dict[str, Exhibition]]:
    projects = {name: lumen.load(DUET, robot=name) for name in NAMES}
    story = projects["ana"].stories["visitor"]
    told = {"ana": story, "ben": None}
    setups = set_up_house(kind, projects, "max", told)
    shows = {name: Exhibition(Plan(projects[name], setups[name], "memory://duet", told[name])) for name in NAMES}
    return House({name: show.services for name, show in shows.items()}, together=True), shows


@pytest.mark.process
def test_they_speak_in_turns(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert check(DUET) == []
    folder = copied_project(DUET, tmp_path / "duet")
    assert main(["run", str(folder), "--story", "visitor", "--robot", "recording", "--speed", "max"]) == 0
    lines = capsys.readouterr().out.splitlines()
    said = [line.split(" robot    ") for line in lines if " robot    “" in line]
    assert [when[-3:] + text for when, text in said] == [
        "ana“Hello! I am Ana.”",
        "ben“And I am Ben!”",
        "ana“Shall we dance for you?”",
        "ana“And now you, Ben!”",
        "ben“Thank you for watching us!”",
    ]


def test_an_event_is_for_one_robot_and_only_what_it_waits_for(heard: Bus) -> None:
    house, shows = duet("recording")
    sent = Collector()
    heard.subscribe("lumen.*.event", sent)
    house.start()
    house.run(0.5)
    before = shows["ben"].configuration
    for body in (
        {"event": "done.command.c1", "data": {}, "from": "ana"},
        {"event": "greet", "data": {}, "from": "eve"},
    ):
        heard.publish("lumen.ben.event", body)
    heard.publish("lumen.ben.event", "greet")
    house.run(0.5)
    assert shows["ben"].configuration == before, "nobody fakes an answer, and strangers are not heard"
    heard.publish("lumen.ben.event", {"event": "greet", "data": {}, "from": "ana"})
    house.run(0.1)
    assert "greeting" in shows["ben"].configuration
    house.close()
    assert {message.key for message in sent.messages} == {"lumen.ben.event"}


@pytest.mark.physics
@pytest.mark.slow
def test_they_dance_in_step_in_one_world(heard: Bus) -> None:
    """The delay of Ben is measured by the right shoulders of both, which the bus has every 20 ms."""
    house, shows = duet("simulation")
    robots: list[Any] = [show.services.setup.robot for show in shows.values()]
    assert robots[0].world.physics is robots[1].world.physics
    felt = Collector()
    heard.subscribe("avatar.*.data.joint", felt)
    house.start()
    while not house.over:
        house.tick()
        if "dancing" not in shows["ana"].configuration:
            felt.messages.clear()
        elif len(felt.messages) > 600:
            break
    while not house.over:
        house.tick()
    house.close()
    assert not shows["ana"].node.failed
    assert not any(robot.fallen for robot in robots)
    ana, ben = (_curve(felt.messages, name) for name in NAMES)
    assert np.ptp(ana[1]) > 1.0, "she dances"
    times = np.arange(ana[0][10], ana[0][-10], 0.005)
    lags = np.arange(-0.1, 0.1001, 0.005)
    apart = [float(np.abs(np.interp(times, *ana) - np.interp(times + lag, *ben)).mean()) for lag in lags]
    assert abs(lags[int(np.argmin(apart))]) <= 0.02


def _curve(messages: list[Message], robot: str) -> tuple[np.ndarray, np.ndarray]:
    """Return the times [s], and the angles of its right shoulder then [rad]."""
    bodies: list[Any] = [message.body for message in messages if message.key == f"avatar.{robot}.data.joint"]
    return np.array([body["time"] for body in bodies]), np.array([_angle(body) for body in bodies])


def _angle(body: Any) -> float:
    return float(body["angle"][body["name"].index(ARM)])
