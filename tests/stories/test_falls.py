"""A story in which the robot falls fails, unless it expects that: `lumen run --story` beside a podium ends badly."""

from types import SimpleNamespace
from typing import Any

import pytest

from lumen.language.events import Event
from lumen.lint import check_files
from lumen.project.files import read_files
from lumen.run.story import StoryPlayer
from lumen.run.story_observations import expects_fall
from tests import ROOT


@pytest.fixture(scope="module")
def project() -> Any:
    return check_files(ROOT, read_files(ROOT))[0]


def player(project: Any, story: str) -> StoryPlayer:
    nothing: Any = SimpleNamespace(project=project)
    return StoryPlayer(project.stories[story], nothing, nothing)


def test_a_fall_that_the_story_does_not_speak_of_fails_it(project: Any) -> None:
    played = player(project, "visitor")
    played.answered(Event("fallen", {}, 12.0))
    assert "expected the robot to stay on its feet, but it fell" in played.failure


def test_a_story_of_a_fall_goes_on(project: Any) -> None:
    played = player(project, "safety_fall")
    played.answered(Event("fallen", {}, 12.0))
    assert played.failure == ""


def test_who_expects_what_answers_a_fall_says_that_it_falls(project: Any) -> None:
    machine = project.behaviors["tour"]
    said = {name for name, story in project.stories.items() if expects_fall(story, machine)}
    assert "safety_fall" in said
    assert "visitor" not in said
