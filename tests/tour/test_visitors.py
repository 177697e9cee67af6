"""Visitors who do what no script of the exhibition foresees."""

from collections.abc import Iterable
from dataclasses import replace

import pytest

from lumen.language.projects import Project
from lumen.language.stories import (
    Arrive,
    Expect,
    Happen,
    Leave,
    Speak,
    Story,
    StoryPause,
    StoryStep,
    Visitor,
    VisitorAction,
)
from tests.tables import for_each
from tests.tour.playing import Run, play


def visit(project: Project, deeds: Iterable[VisitorAction], **changes: object) -> Run:
    story = Story("made", "made for a test", tuple(StoryStep(deed) for deed in deeds))
    return play(project, replace(story, **changes))  # type: ignore[arg-type]


def test_who_stays_is_not_greeted_again_at_once(project: Project) -> None:
    run = visit(project, [Arrive(Visitor()), Expect(("goodbye",), within=60.0), Expect(("greet",)), StoryPause(1.0)])
    assert run.failure == ""
    farewell = next(at for at, text in run.said if "Goodbye" in text)
    again = next(at for at, text in run.said if at > farewell)
    assert again - farewell >= 10


def test_faces_by_the_dozen_begin_one_conversation(project: Project) -> None:
    run = visit(project, [Arrive(Visitor()), Expect(("ask_name",)), StoryPause(20.0)])
    assert run.guide() == ["idle", "greet", "ask_name"]
    assert len(run.said) == 3


def test_what_is_said_during_the_greeting_does_not_cut_it(project: Project) -> None:
    run = visit(project, [Arrive(Visitor()), Expect(("greet",)), Speak("hello there"), Expect(("ask_name",))])
    assert run.guide() == ["idle", "greet", "ask_name"]
    assert any("I am Lumen" in text for _, text in run.said)


def test_another_trouble_during_the_first_is_not_forgotten_by_the_guide(project: Project) -> None:
    """The robot falls while the battery is low: the guide does nothing until the robot stands."""
    deeds: list[VisitorAction] = [
        Arrive(Visitor()),
        Expect(("ask_name",)),
        Happen("battery.low", {"percentage": 9}),
        Expect(("battery_low", "interrupted"), within=1.0),
        Happen("fallen"),
        Expect(("fallen", "interrupted"), said="I fell", within=1.0),
        Expect(("watching", "ask_name"), said="on my feet"),
    ]
    assert visit(project, deeds).failure == ""


@pytest.mark.parametrize("state", ["stopped", "resting", "helpless"])
def test_a_robot_with_its_motors_off_does_not_get_up_by_itself(project: Project, state: str) -> None:
    """It notes `fallen`, and nothing moves until a hand holds its head."""
    begin: dict[str, VisitorAction] = {
        "stopped": Happen("stop"),
        "resting": Happen("head.held"),
        "helpless": Happen("fallen"),
    }
    robot = {"posture": "fails"} if state == "helpless" else {}
    deeds: list[VisitorAction] = [
        StoryPause(1.0),
        begin[state],
        Expect((state,)),
        Happen("fallen"),
        StoryPause(5.0),
        Expect((state, "paused")),
    ]
    run = visit(project, deeds, robot=robot)
    assert run.failure == ""
    assert any("fallen" in line for line in run.logged)


@for_each("verb", ["say", "play", "posture", "wake", "rest"])
@for_each("how", ["fails", "hangs"])
def test_whatever_of_the_robot_is_broken_it_is_idle_again(project: Project, verb: str, how: str) -> None:
    deeds: list[VisitorAction] = [
        Arrive(Visitor()),
        Expect(("talking",)),
        Expect(("goodbye",), within=90.0),
        Leave(),
        Expect(("idle",)),
    ]
    assert visit(project, deeds, robot={verb: how}).failure == ""


def test_a_stop_is_announced_even_where_the_robot_can_not_crouch(project: Project) -> None:
    deeds: list[VisitorAction] = [
        StoryPause(1.0),
        Happen("stop"),
        Expect(("stopped", "paused"), said="I have stopped"),
        StoryPause(3.0),
    ]
    run = visit(project, deeds, robot={"rest": "fails"})
    assert run.failure == ""
    assert run.errors == ["error.communication"]
