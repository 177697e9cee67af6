"""Files saved while a show runs: a good one is in force with the next sentence, a broken one changes nothing."""

import shutil
import time
from collections.abc import Callable, Iterator
from io import StringIO
from pathlib import Path

import pytest

import lumen
from lumen.cli.cast import Cast
from lumen.cli.reloading.reloading import Reloading
from lumen.cli.show import Show
from lumen.cli.transcript import Transcript
from lumen.clocks.simulated import SimulatedClock
from lumen.language.stories import Visitor
from lumen.robots.recording import RecordingRobot

DEADLINE = 20.0


class Running:
    """A show of the project in a folder, with a transcript to read."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        project = lumen.load(folder)
        robot = RecordingRobot(project.body)
        self.show = Show(project, Cast(robot, SimulatedClock(robot.advance, 5.0), robot))
        self.told = StringIO()
        transcript = Transcript(self.show.exhibition.clock.now, lambda: self.show.exhibition.project.machine, self.told)
        self.show.exhibition.observers.append(transcript)
        reloading = Reloading(self.show, transcript)
        self.show.exhibition.parts.append(reloading.tick)
        self.show.closing.insert(0, reloading.close)
        self.show.start()

    def until(self, condition: Callable[[], object]) -> None:
        """Tick until it holds."""
        deadline = time.monotonic() + DEADLINE
        while not condition():
            self.show.tick()
            assert time.monotonic() < deadline, self.told.getvalue()

    def until_told(self, text: str) -> None:
        self.until(lambda: text in self.transcript)

    def edit(self, old: str, new: str, file: str = "behaviors/tour.yaml") -> None:
        path = self.folder / file
        text = path.read_text("utf-8")
        assert old in text
        path.write_text(text.replace(old, new), "utf-8")

    @property
    def transcript(self) -> str:
        """What was told, its lines not wrapped."""
        return self.told.getvalue().replace("\n" + " " * 18, " ")

    @property
    def states(self) -> frozenset[str]:
        return self.show.exhibition.runtime.snapshot.configuration


@pytest.fixture
def running(copy: Path) -> Iterator[Running]:
    one = Running(copy)
    yield one
    one.show.close()


def test_a_saved_text_is_the_next_sentence(running: Running) -> None:
    running.edit("en: I am sorry, I did not understand that.", "en: Come again, please?")
    running.until_told("in force")
    walker = running.show.walker
    assert walker
    walker.arrive(Visitor())
    running.until_told("ask_name")
    walker.speak("my name is Ada")
    running.until_told("how_are_you")
    walker.speak("purple")
    running.until_told("“Come again, please?”")


def test_the_visitors_name_survives(running: Running) -> None:
    walker = running.show.walker
    assert walker
    walker.arrive(Visitor())
    running.until_told("ask_name")
    walker.speak("my name is Ada")
    running.until(lambda: "how_are_you" in running.states)
    running.edit("en: [I am glad to hear that.,", 'en: ["Wonderful, {{ context.visitor }}!",')
    running.edit('"That is good to hear, {{ context.title_en }}."]', '"Wonderful, {{ context.visitor }}!"]')
    running.until_told("in force")
    assert "how_are_you" in running.states
    walker.speak("fine")
    running.until_told("“Wonderful, Ada!”")


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("onDone: any_question", "onDone: any_questoin", "did you mean `any_question`?"),
        ("id: tour", "id: tour\n\tx: 1", "[tab]"),
        ("{play: sing}", "{play: sign}", "did you mean `sing`?"),
    ],
)
def test_a_broken_file_is_reported_with_its_place_and_changes_nothing(
    running: Running, old: str, new: str, told: str
) -> None:
    before = running.show.exhibition.project
    running.edit(old, new)
    running.until_told("refused: the exhibition goes on as it was")
    assert told in running.transcript
    assert "behaviors/tour.yaml:" in running.transcript
    assert running.show.exhibition.project is before
    running.edit(new, old)
    running.edit("en: Never mind.", "en: No problem.")
    running.until_told("in force")


@pytest.fixture
def storyless(copy: Path) -> Path:
    """A project whose states may be renamed: no story names them."""
    shutil.rmtree(copy / "behaviors" / "stories")
    main = copy / "lumen.yaml"
    main.write_text(main.read_text("utf-8").replace("story: visitor", "#"), "utf-8")
    return copy


def test_a_state_that_is_active_is_not_taken_away(storyless: Path, running: Running) -> None:
    walker = running.show.walker
    assert walker
    walker.arrive(Visitor())
    running.until(lambda: "ask_name" in running.states)
    for old, new in (
        ("          ask_name:\n            id: ask_name", "          asking:\n            id: asking"),
        ("target: ask_name", "target: asking"),
        ("- ask_name", "- asking"),
        ("onError: ask_name", "onError: asking"),
    ):
        running.edit(old, new)
    running.until_told("waiting for `ask_name`: `ask_name` is active and gone")
    walker.speak("my name is Ada")
    running.until_told("in force")
    assert "how_are_you" in running.states
