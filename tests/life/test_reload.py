"""A style that is saved while the exhibition runs: the robot lives so from the next tick on; nothing else differs."""

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest

import lumen
from lumen.clock.simulated import SimulatedClock
from lumen.insight.migration import MigrationPlan
from lumen.language.stories import Visitor
from lumen.ports import Live, RobotCommand
from lumen.robot.recording import RecordingRobot
from lumen.run.exhibition import Exhibition
from lumen.run.setup import Setup
from tests import ROOT
from tests.nodes import whole


class Told(RecordingRobot):
    """A recording robot that keeps its styles of life."""

    lives: list[Live]

    def start(self, id: str, command: RobotCommand) -> None:
        if isinstance(command, Live):
            self.lives.append(command)
        super().start(id, command)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for name in ("models", "motions", "behaviors", "functions", "fuzzy", "schemas"):
        shutil.copytree(ROOT / name, tmp_path / name)
    shutil.copy(ROOT / "lumen.yaml", tmp_path)
    return tmp_path


@pytest.fixture
def show(folder: Path) -> Iterator[Exhibition]:
    project = lumen.load(folder)
    robot = Told(project.body)
    robot.lives = []
    show = whole(project, Setup(robot, SimulatedClock(robot.advance), robot))
    show.start()
    assert show.visitor
    show.visitor.arrive(Visitor())
    live(show, 2.5)
    yield show
    show.close()


def live(show: Exhibition, seconds: float) -> None:
    for _ in range(round(seconds / 0.02)):
        show.tick()


def lives(show: Exhibition) -> list[Live]:
    assert isinstance(show.services.setup.robot, Told)
    return show.services.setup.robot.lives


def save(show: Exhibition, folder: Path, file: str, old: str, new: str) -> None:
    path = folder / "motions" / file
    assert old in path.read_text("utf-8")
    path.write_text(path.read_text("utf-8").replace(old, new), "utf-8")
    project = lumen.load(folder)
    plan = show.behavior.plan(project)
    assert isinstance(plan, MigrationPlan)
    show.behavior.apply(project, plan)


def test_a_style_that_is_saved_is_lived_at_once(show: Exhibition, folder: Path) -> None:
    before, state = lives(show)[-1], show.loop.runtime.snapshot.configuration
    assert before.style.name == "lively"
    save(show, folder, "life/lively.yaml", "glances: {every: 5s, yaw: 10", "glances: {every: 5s, yaw: 3")
    show.tick()
    now = lives(show)[-1]
    assert now.style.glances
    assert before.style.glances
    assert now.style.glances.yaw == pytest.approx(0.3 * before.style.glances.yaw)
    assert now.style.sways == before.style.sways
    assert show.loop.runtime.snapshot.configuration == state


def test_gestures_that_are_saved_are_those_of_the_next_text(show: Exhibition, folder: Path) -> None:
    before = len(lives(show)[-1].gestures.gestures)
    save(show, folder, "gestures/guide.yaml", "  small_bow:\n    for: greeting", "  bow:\n    for: greeting")
    show.tick()
    names = {gesture.name for gesture in lives(show)[-1].gestures.gestures}
    assert len(names) == before
    assert "bow" in names


def test_a_style_of_another_state_changes_nothing_now(show: Exhibition, folder: Path) -> None:
    before = lives(show)[-1]
    save(show, folder, "life/listening.yaml", "nods: {every: 3s, pitch: 5}", "nods: {every: 2s, pitch: 5}")
    live(show, 0.2)
    assert lives(show)[-1] == before
