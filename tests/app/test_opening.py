"""An exhibition in another program: opened, stepped, observed, reloaded, asked to stop, and closed."""

import sys
from collections.abc import Sequence
from pathlib import Path

import pytest

import lumen
from lumen.bus.memory import MemoryBus
from lumen.language.commands import Say
from lumen.language.events import Event
from lumen.language.stories import Visitor
from lumen.ports import Reading, RobotCommand, Sense
from lumen.statechart import Step, VirtualClock
from tests import ROOT
from tests.guarded import run_guarded


class Parrot:
    """A robot from outside Lumen: it completes each command at once and remembers the texts it spoke."""

    def __init__(self) -> None:
        self.said: list[str] = []
        self.closed = False
        self._answers: list[Event] = []

    def start(self, id: str, command: RobotCommand) -> None:
        if isinstance(command, Say):
            self.said.append(command.text)
        self._answers.append(Event(f"done.command.{id}", None, 0.0))

    def cancel(self, id: str) -> None:
        self._answers.append(Event(f"cancelled.command.{id}", None, 0.0))

    def poll(self) -> Sequence[Event]:
        answers, self._answers = self._answers, []
        return answers

    def begun(self) -> Sequence[str]:
        return ()

    def read(self, sense: Sense) -> Reading | None:
        return None

    def close(self) -> None:
        self.closed = True


def test_a_visit_in_fifteen_lines() -> None:
    steps: list[Step] = []
    with lumen.open(ROOT) as exhibition:
        assert "idle" in exhibition.configuration
        exhibition.observe(steps.append)
        assert exhibition.visitor
        exhibition.visitor.arrive(Visitor())
        assert exhibition.run(seconds=10) == pytest.approx(10.0)
        exhibition.send("heard", {"result": "my name is Ada"})
        exhibition.run(seconds=1)
        assert exhibition.context["visitor"] == "Ada"
        exhibition.stop()
        exhibition.run(seconds=1)
        assert "stopped" in exhibition.configuration
        assert exhibition.tick() == exhibition.now == pytest.approx(12.02)
    assert any("ask_name" in step.entered for step in steps)


def test_any_robot_bus_and_clock() -> None:
    robot, bus, clock = Parrot(), MemoryBus(), VirtualClock(100.0)
    heard: list[object] = []
    bus.subscribe("avatar.NAO.text", lambda message: heard.append(message.body))
    with lumen.open(ROOT, robot=robot, bus=bus, clock=clock, language="id") as exhibition:
        assert exhibition.visitor is None
        exhibition.run(seconds=1)
        assert exhibition.now == clock.now() == pytest.approx(101.0)
        exhibition.say("Selamat datang")
        assert exhibition.send("heard", {"result": "halo"}) is None
        exhibition.run(seconds=1)
    assert robot.said[0] == "Selamat datang"
    assert robot.closed


def test_an_exhibition_that_can_not_start_lets_go_of_its_robot(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(exhibition: object) -> None:
        raise OSError("the disk is gone")

    monkeypatch.setattr("lumen.run.exhibition.Exhibition.start", fail)
    parrot = Parrot()
    with pytest.raises(OSError, match="the disk is gone"):
        lumen.open(ROOT, robot=parrot)
    assert parrot.closed


def test_a_story_runs_to_its_end() -> None:
    with lumen.open(ROOT, story="shy") as exhibition:
        lived = exhibition.run()
        assert exhibition.over
    assert lived > 1.0


@pytest.mark.process
def test_files_are_taken_refused_and_named(copy: Path) -> None:
    file = copy / "behaviors" / "tour.yaml"
    text = file.read_text("utf-8")
    with lumen.open(copy) as exhibition:
        exhibition.run(seconds=1)
        assert exhibition.reload().verdict == "unchanged"
        words = copy / "behaviors" / "words" / "faq.yaml"
        answers = words.read_text("utf-8")
        words.write_text(answers.replace("a little more than five kilograms", "five kilograms"), "utf-8")
        report = exhibition.reload()
        assert report.verdict == "applied"
        assert [change.kind for change in report.changes] == ["text"]
        assert report.diagnostics == ()
        before = exhibition.project
        file.write_text(text.replace("visitor.left: goodbye", "visitor.left: godbye"), "utf-8")
        report = exhibition.reload()
        assert report.verdict == "refused"
        assert any("godbye" in diagnostic.message for diagnostic in report.diagnostics)
        exhibition.run(seconds=1)
        assert exhibition.project is before


def test_what_is_wrong_is_said() -> None:
    with pytest.raises(lumen.UsageError, match="no robot `toaster`"):
        lumen.open(ROOT, robot="toaster")
    with pytest.raises(lumen.UsageError, match="no project or story `nobody`"):
        lumen.open(ROOT, story="nobody")
    with pytest.raises(lumen.UsageError, match="must be a multiple of real time"):
        lumen.open(ROOT, speed="fast")
    with lumen.open(ROOT) as exhibition:
        with pytest.raises(lumen.UsageError, match="there is no route `hears`"):
            exhibition.send("hears", {})
        with pytest.raises(lumen.UsageError, match="can't send on `heard`"):
            exhibition.send("heard", {"result": 7})


@pytest.mark.slow
def test_the_example_runs() -> None:
    told = run_guarded(
        [sys.executable, "examples/embed/clock_tower.py"], cwd=ROOT, capture_output=True, text=True, check=True
    )
    assert "remembered: Ada" in told.stdout
    assert "files: unchanged" in told.stdout
