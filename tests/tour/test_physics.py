"""The tour on the simulated robot, with physics."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from lumen.features.simulation.offers import SimulatedRobot
from lumen.language.projects import Project
from lumen.language.stories import Arrive, Expect, Story, StoryPause, StoryStep, Visitor, VisitorAction
from tests.tour.playing import play


@pytest.fixture
def blind(project: Project) -> Project:
    """The exhibition without its camera, whose pictures take longer than everything else."""
    return replace(project, routes={name: route for name, route in project.routes.items() if name != "image"})


@pytest.fixture
def robot(project: Project) -> Iterator[SimulatedRobot]:
    simulated = SimulatedRobot(project.body, Path(project.root) / "models", project.hall)
    yield simulated
    simulated.close()


def test_the_shipped_story_in_physics(blind: Project, robot: SimulatedRobot) -> None:
    """Every motion comes to its end, the robot never leans far, and the tour is the one of the recording robot."""
    recorded = play(blind, blind.stories["visitor"])
    run = play(blind, blind.stories["visitor"], robot)
    assert run.failure == ""
    assert run.errors == []
    assert run.played == ["dance", "sing", "photo", "goodbye"]
    assert run.guide() == recorded.guide()
    assert [text for _, text in run.said] == [text for _, text in recorded.said]
    assert not robot.fallen
    assert robot.greatest_tilt < 20.0


@pytest.mark.once
def test_who_is_pushed_over_gets_up_and_goes_on(blind: Project, robot: SimulatedRobot) -> None:
    """A push of 70 N from behind during the greeting: the robot reports it, stands up by itself, and reports that."""

    def push(now: float) -> None:
        robot.world.data.xfrc_applied[robot.world.torso][0] = 70.0 if 7.0 < now < 7.15 else 0.0

    deeds: list[VisitorAction] = [
        StoryPause(3.0),
        Arrive(Visitor()),
        Expect(("greet",)),
        Expect(("fallen", "interrupted"), said="I fell"),
        Expect(("watching",), said="on my feet again", within=60.0),
    ]
    run = play(blind, Story("pushed", "Pushed over", tuple(StoryStep(d) for d in deeds)), robot, part=push)
    assert run.failure == ""
    assert not robot.fallen
    assert robot.world.tilt < 0.1
