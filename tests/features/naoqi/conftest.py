from collections.abc import Callable, Iterator

import pytest

from lumen.language.events import Event
from lumen.language.projects import Project
from tests.features.naoqi.lockstep import Lockstep
from tests.tour.conftest import project

__all__ = ["project"]

Live = Callable[[float], list[Event]]


@pytest.fixture
def robot(project: Project) -> Iterator[Lockstep]:
    """The adapter of NAOqi, connected to a fake robot of its own."""
    one = Lockstep(project)
    yield one
    one.close()


@pytest.fixture
def live(robot: Lockstep) -> Live:
    """A function that advances the robot by some seconds and returns the robot's events."""

    def lived(seconds: float) -> list[Event]:
        events: list[Event] = []
        for _ in range(round(seconds / 0.02)):
            robot.advance(0.02)
            events += robot.poll()
        return events

    return lived
