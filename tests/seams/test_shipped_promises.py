"""The promises that `pytest --lumen-robot` tries with a robot of one's own, kept by the robots of Lumen."""

from collections.abc import Iterator

import pytest

from lumen.language.projects import Project
from lumen.testing.robot_promises import *  # noqa: F403 - pytest collects the tests of that module here
from lumen.testing.trial import RobotTrial
from tests.seams.test_robot import ROBOTS, project

__all__ = ["project"]
LONG = ("simulation", "naoqi")
"""Robots that cost too much processor time for `make test`."""


@pytest.fixture(params=[pytest.param(name, marks=[pytest.mark.slow] if name in LONG else []) for name in ROBOTS])
def trial(request: pytest.FixtureRequest, project: Project) -> Iterator[RobotTrial]:
    made = RobotTrial(request.param, project, ROBOTS[request.param](project))
    yield made
    made.close()
