"""The shipped story on the fake NAO: the same states, words and motions as on the recording robot."""

from dataclasses import replace

import pytest

from lumen.language.projects import Project
from lumen.robot.recording import RecordingRobot
from tests.features.naoqi.lockstep import Lockstep
from tests.tour.playing import Run, play

pytestmark = pytest.mark.rest  # expensive


def played(project: Project, robot: Lockstep | RecordingRobot) -> Run:
    return play(project, project.stories["visitor"], robot)


def guided(run: Run) -> list[str]:
    """Return the states that a run entered, without those that depend on when a camera sees a face."""
    return [state for state in run.entered if not state.startswith("face.")]


@pytest.mark.slow
def test_the_whole_tour_is_the_recording_robots_tour(project: Project) -> None:
    joint = replace(project.routes["joint"], every=0.2)
    blind = replace(project, routes={**{n: r for n, r in project.routes.items() if n != "image"}, "joint": joint})
    robot = Lockstep(blind, all_fresh=False)
    real, recorded = played(blind, robot), played(blind, RecordingRobot(project.body))
    assert real.failure == ""
    assert real.errors == []
    assert guided(real) == guided(recorded)
    assert [text for _, text in real.said] == [text for _, text in recorded.said]
    assert real.played == recorded.played == ["dance", "sing", "photo", "goodbye"]
    assert real.time == pytest.approx(recorded.time, abs=10.0)
    world = robot.nao.world
    assert [said for said, _ in world.called("say")] == [text for _, text in real.said]
    assert len(world.called("angleInterpolationBezier")) == len(real.played)
