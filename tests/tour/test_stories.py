"""The shipped stories on the recording robot, in virtual time."""

from dataclasses import replace
from functools import cache
from itertools import pairwise
from pathlib import Path

import pytest

from lumen.cli.main import main
from lumen.language.projects import Project
from lumen.language.stories import Arrive, Expect, Story, StoryStep, Visitor
from lumen.project.schedules import read_schedule
from lumen.run.coverage import Coverage
from lumen.run.exploring import explored
from tests import ROOT
from tests.scanning import matching
from tests.tables import for_each
from tests.tour.names import GUIDE, SAFETY
from tests.tour.playing import Run, play

GRANTED = """
steps:
  - visitor: arrives
  - expect: {state: ask_name}
  - says: My name is Dewi
  - expect: {state: how_are_you}
  - says: fine
  - expect: {state: offer}
  - says: I would love to see how you move to music
  - answers: {raise: wish.dance, data: {}}
  - expect: {state: offer, played: dance, within: 1min}
"""
STORIES = sorted(path.stem for path in matching(ROOT, "behaviors/stories/*.yaml"))


@pytest.fixture(scope="module")
def coverage(project: Project) -> Coverage:
    """The coverage of all stories that `run` has played."""
    return Coverage(project)


@pytest.fixture(scope="module")
def run(project: Project, coverage: Coverage):  # type: ignore[no-untyped-def]
    """Return a function that plays each story once, however many tests call it."""

    @cache
    def played(name: str) -> Run:
        return play(project, project.stories[name], observers=[coverage.of(project.behavior)])

    return played


@for_each("name", STORIES)
def test_the_story_ends_well(run, project: Project, name: str) -> None:  # type: ignore[no-untyped-def]
    story = run(name)
    assert story.failure == ""
    if "fails" not in project.stories[name].robot.values():
        assert story.errors == []


@pytest.mark.slow
def test_the_stories_together_enter_every_state_and_take_every_transition(  # type: ignore[no-untyped-def]
    run, coverage: Coverage
) -> None:
    for name in STORIES:
        run(name)
    assert [str(gap) for gap in coverage.gaps()] == []
    assert coverage.entered["tour"] >= {*GUIDE, *SAFETY, "paused", "interrupted"}


@pytest.mark.slow
def test_whatever_happens_the_tour_comes_back_to_where_it_began(project: Project) -> None:
    found = explored(project, "tour", bound=10_000)
    assert found.complete
    assert found.findings == ()
    assert found.unseen == ()


def test_the_shipped_story_goes_through_the_tour(run) -> None:  # type: ignore[no-untyped-def]
    story = run("visitor")
    assert story.guide() == [
        "idle", "greet", "ask_name", "how_are_you", "fine", "offer", "explain", "any_question", "answer",
        "any_question", "dance", "offer", "sing", "offer", "photo", "offer", "goodbye", "idle",
    ]  # fmt: skip
    assert story.played == ["dance", "sing", "photo", "goodbye"]
    assert 120 < story.time < 240


def test_the_shipped_story_is_said_in_full_and_once(run) -> None:  # type: ignore[no-untyped-def]
    texts = [text for _, text in run("visitor").said]
    assert texts[0] == "Good morning!"
    assert texts[-1] == "Thank you for your visit, my friend. Goodbye!"
    once = [t for t in texts if not t.startswith(("What else", "Is there"))]
    assert len(once) == len(set(once))


def test_nobody_interrupts_the_robot_in_the_shipped_story(run) -> None:  # type: ignore[no-untyped-def]
    """The visitor waits until the robot has spoken: no sentence begins before the one before it has ended."""
    said = run("visitor").said
    for (begun, text), (following, _) in pairwise(said):
        assert following - begun >= 0.4 + 0.06 * len(text), text


def test_in_indonesian_only_indonesian_is_said(run) -> None:  # type: ignore[no-untyped-def]
    texts = " ".join(text for _, text in run("indonesian").said)
    assert "Selamat sore!" in texts
    assert not {"the", "you", "your", "What"} & set(texts.split())


@for_each(
    ("clock", "english", "indonesian"),
    [
        ("00:30", "Good morning!", "Selamat pagi!"),
        ("10:59", "Good morning!", "Selamat pagi!"),
        ("11:01", "Good afternoon!", "Selamat siang!"),
        ("15:01", "Good afternoon!", "Selamat sore!"),
        ("17:30", "Good afternoon!", "Selamat sore!"),
        ("18:01", "Good evening!", "Selamat malam!"),
        ("23:30", "Good evening!", "Selamat malam!"),
    ],
)
def test_the_greeting_suits_the_hour(project: Project, clock: str, english: str, indonesian: str) -> None:
    story = Story("hour", "Somebody comes at some hour", (StoryStep(Arrive(Visitor())), StoryStep(Expect(("greet",)))))
    for language, greeting in (("en", english), ("id", indonesian)):
        assert play(project, replace(story, clock=read_schedule(clock), language=language)).said[0][1] == greeting


def test_a_wish_that_a_model_raises_ends_the_answer_and_not_the_dance(copy: Path) -> None:
    settings = copy / "lumen.yaml"
    model = '  answers: {here: true, model: {url: "http://127.0.0.1:9/v1/chat/completions", name: none}}\n'
    settings.write_text(settings.read_text("utf-8").replace("modules:\n", f"modules:\n{model}", 1), "utf-8")
    (copy / "behaviors" / "stories" / "granted.yaml").write_text(GRANTED, "utf-8")
    assert main(["test", str(copy), "granted"]) == 0
