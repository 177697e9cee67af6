"""Words and sounds of a motion: every robot reports them at their times, and the exhibition speaks them."""

import logging
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

import lumen
from lumen.clock.simulated import SimulatedClock
from lumen.features.simulation.offers import SimulatedRobot
from lumen.language.commands import Command, PlaySound, Say, Start
from lumen.language.events import CUE, Event
from lumen.language.projects import Project
from lumen.ports import Perform
from lumen.robot.recording import RecordingRobot
from lumen.run.exhibition import Exhibition
from lumen.run.loop import Observer
from lumen.run.setup import Setup
from lumen.run.sound import Sound, save
from tests import ROOT
from tests.motions.making import made, nao
from tests.nodes import whole

GREETING = """
start: Stand
keyframes:
  - {at: 0s, say: {en: Look!, id: Lihat!}}
  - {at: 1s, joints: {RShoulderPitch: 1.0}}
  - {at: 1s, sound: sounds/beat.wav}
  - {at: 1500ms, say: Bye}
"""
BEHAVIOR = """
initial: idle
states:
  idle: {after: {100ms: greet}}
  greet:
    do: {play: greeting}
    onDone: over
    on: {touched: over}
  over: {on: {touched: idle}}
"""


def simulated() -> SimulatedRobot:
    return SimulatedRobot(nao(), ROOT / "models")


def recording() -> RecordingRobot:
    return RecordingRobot(nao())


@pytest.mark.parametrize("make", [simulated, recording])
def test_a_robot_tells_of_each_cue_when_it_comes(make: Callable[[], SimulatedRobot | RecordingRobot]) -> None:
    robot, came = make(), list[Event]()
    robot.start("it", Perform(made(GREETING)))
    for _ in range(200):
        robot.advance(0.02)
        came += robot.poll()
    cues = [event for event in came if event.name == CUE]
    assert [(e.data["kind"], e.data["value"]) for e in cues] == [
        ("say", {"en": "Look!", "id": "Lihat!"}),
        ("sound", "sounds/beat.wav"),
        ("say", "Bye"),
    ]
    assert [e.at - cues[0].at for e in cues] == pytest.approx([0.0, 1.0, 1.5], abs=0.021)
    assert [e.name for e in came if e.name != CUE] == ["done.command.it"]


class Ear(Observer):
    """Keeps the spoken texts, and what the robot reports."""

    def __init__(self) -> None:
        self.said: list[Say] = []
        self.told: list[Event] = []

    def performing(self, command: Command, now: float) -> None:
        if isinstance(command, Start) and isinstance(command.command, Say):
            self.said.append(command.command)

    def answered(self, event: Event) -> None:
        self.told.append(event)


@pytest.fixture
def project(tmp_path: Path) -> Project:
    """The shipped project with a behaviour that greets."""
    shutil.copytree(ROOT / "models", tmp_path / "models")
    shutil.copytree(ROOT / "schemas", tmp_path / "schemas")
    for folder, name, text in (("motions", "greeting", GREETING), ("behaviors", "hello", BEHAVIOR)):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / f"{name}.yaml").write_text(text)
    (tmp_path / "lumen.yaml").write_text(
        "name: Hello\nrobot: {name: NAO, model: nao}\nlanguages: [en, id]\nbehavior: hello\n"
    )
    return lumen.load(tmp_path)


def run(
    project: Project, seconds: float, touch: float = 99.0, language: str = ""
) -> tuple[Ear, RecordingRobot, Exhibition]:
    robot, ear = RecordingRobot(project.body), Ear()
    show = whole(project, Setup(robot, SimulatedClock(robot.advance), robot), language=language, silent=True)
    show.loop.observers.append(ear)
    show.start()
    for i in range(round(seconds / 0.02)):
        if i == round(touch / 0.02):
            robot.touch("FrontTactil", True)
        show.tick()
    show.close()
    return ear, robot, show


def test_an_exhibition_speaks_them_in_its_language_and_the_behaviour_hears_nothing_of_it(project: Project) -> None:
    ear, robot, show = run(project, 4.0, language="id")
    assert ear.said == [Say("Lihat!", "id"), Say("Bye", "id")]
    assert [c for _, c in robot.performed if isinstance(c, Say)] == ear.said
    assert show.loop.runtime.snapshot.configuration == {"over"}


def test_words_end_with_a_motion_that_is_cancelled(project: Project) -> None:
    ear, _, _ = run(project, 4.0, touch=0.3)
    assert [say.text for say in ear.said] == ["Look!"]
    assert any(event.name == "cancelled.command.cue1" for event in ear.told)


def test_a_sound_is_told_and_one_that_is_missing_is_logged_once(
    project: Project, caplog: pytest.LogCaptureFixture
) -> None:
    caplog.set_level(logging.WARNING)
    ear, _, _ = run(project, 4.0)
    assert [e.data["value"] for e in ear.told if e.name == CUE and e.data["kind"] == "sound"] == ["sounds/beat.wav"]
    assert sum("sounds/beat.wav" in record.getMessage() for record in caplog.records) == 1
    there = Path(project.root) / "sounds"
    there.mkdir()
    beat = Sound(8_000, bytes(8_000))
    save(there / "beat.wav", beat)
    caplog.clear()
    _, robot, _ = run(project, 4.0)
    assert not caplog.records
    assert [command for _, command in robot.performed if isinstance(command, PlaySound)] == [
        PlaySound("sounds/beat.wav", beat.duration)
    ]
