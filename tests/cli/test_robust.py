"""A running show continues whatever a message, a file or a person does."""

from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest

import lumen
from lumen.cli.transcript import Transcript
from lumen.clock.simulated import SimulatedClock
from lumen.insight.migration import MigrationPlan
from lumen.language.projects import Project
from lumen.language.stories import Visitor
from lumen.robot.recording import RecordingRobot
from lumen.run.exhibition import Exhibition
from lumen.run.setup import Setup
from tests.nodes import whole

HEAD = ["HeadYaw", "HeadPitch"]


def show_of(project: Project) -> Exhibition:
    robot = RecordingRobot(project.body)
    transcript = Transcript(lambda: show.now, lambda: show.project.machine)
    show = whole(project, Setup(robot, SimulatedClock(robot.advance), robot), narrator=transcript)
    show.start()
    return show


@pytest.fixture
def show(copy: Path) -> Iterator[Exhibition]:
    one = show_of(lumen.load(copy))
    yield one
    one.close()


def states(show: Exhibition) -> frozenset[str]:
    return show.loop.runtime.snapshot.configuration


def live(show: Exhibition, seconds: float) -> None:
    for _ in range(round(seconds / 0.02)):
        show.tick()


def reload(show: Exhibition, project: Project) -> None:
    plan = show.behavior.plan(project)
    assert isinstance(plan, MigrationPlan)
    show.behavior.apply(project, plan)


def greeted(show: Exhibition) -> None:
    assert show.visitor
    show.visitor.arrive(Visitor())
    live(show, 2.0)
    assert "greet" in states(show)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("key", "body"),
    [
        ("avatar.NAO.data.joint", {"name": HEAD, "angle": [0.1], "stiffness": []}),
        ("avatar.NAO.data.joint", {"name": HEAD, "angle": [0.1, 0.2], "stiffness": [1, 1], "time": 1e12}),
        ("lumen.visual.face.detection", {"x": 10, "y": 10, "time": 1754000000}),
        ("lumen.visual.face.detection", {"x": 10**400, "y": 10}),
        ("lumen.visual.face.detection", [1]),
        ("lumen.audio.speech.recognition", {"result": ["my name is"]}),
        ("avatar.NAO.command", {"type": "motion", "method": "moveto", "parameter": {"x": 10**400}}),
        ("avatar.NAO.command", {"type": 7}),
    ],
)
def test_no_message_ends_it_or_switches_the_head_off(show: Exhibition, key: str, body: Any) -> None:
    greeted(show)
    with suppress(lumen.BusError):
        show.services.bus.publish(key, body)
    live(show, 6.0)
    assert show.robot.faces
    assert show.robot.faces.last
    assert abs(show.robot.faces.last[0] - 160) < 10


def edit(folder: Path, old: str, new: str, file: str = "behaviors/tour.yaml") -> Project:
    path = folder / file
    text = path.read_text("utf-8")
    assert old in text
    path.write_text(text.replace(old, new), "utf-8")
    return lumen.load(folder)


@pytest.mark.slow
def test_a_changed_after_of_the_active_state_runs_from_when_it_was_set(copy: Path, show: Exhibition) -> None:
    greeted(show)
    live(show, 6.0)
    assert "ask_name" in states(show)
    asked = show.loop.clock.now()
    reload(show, edit(copy, 'after: {30s: "#goodbye"}', 'after: {10s: "#goodbye"}'))
    while "goodbye" not in states(show):
        show.tick()
        assert show.loop.clock.now() < asked + 11.0
    assert show.loop.clock.now() < asked + 10.5


@pytest.mark.slow
def test_routes_that_moved_are_spoken_and_heard_on_their_new_keys(copy: Path, show: Exhibition) -> None:
    edit(copy, "lumen.audio.speech.recognition", "lumen.audio.ears", "lumen.yaml")
    project = edit(copy, "lumen.visual.face.detection", "lumen.visual.eyes", "lumen.yaml")
    reload(show, project)
    greeted(show)
    live(show, 6.0)
    assert show.visitor
    show.visitor.speak("my name is Ada")
    live(show, 0.1)
    assert show.loop.runtime.snapshot.context["visitor"] == "Ada"


@pytest.mark.slow
def test_a_livelock_drops_the_event_that_began_it(copy: Path) -> None:
    loop = "  spin:\n    initial: still\n    states:\n      still: {on: {stop: x}}\n"
    loop += "      x: {always: {guard: 'context.battery == 100', target: y}}\n"
    loop += "      y: {always: {guard: 'context.battery == 100', target: x}}\n"
    edit(copy, "\n  touch:\n", f"\n{loop}  touch:\n")
    show = show_of(lumen.load(copy))
    show.loop.happen(lumen.Event("stop", {}))
    live(show, 0.5)
    greeted(show)
    show.close()


def test_an_error_that_the_behaviour_raises_itself(copy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    project = edit(copy, "entry: {wake: true}", "entry: [{wake: true}, {raise: error.mine}]")
    show = show_of(project)
    live(show, 0.5)
    show.close()
    assert "error.mine" in capsys.readouterr().out
