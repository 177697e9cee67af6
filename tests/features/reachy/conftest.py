from collections.abc import Iterator

import pytest

from lumen.features.reachy import link, skills
from lumen.language.projects import Project
from tests.features.reachy.driving import Driven, reachy_project
from tests.features.reachy.fake import FakeDaemon
from tests.waiting import UNLIMITED


@pytest.fixture(scope="session")
def project() -> Project:
    return reachy_project()


@pytest.fixture
def patient(monkeypatch: pytest.MonkeyPatch) -> None:
    """A daemon on a crowded machine may be silent, and the head late, for longer than on a robot."""
    monkeypatch.setattr(link, "SILENCE", UNLIMITED)
    monkeypatch.setattr(skills, "GRACE", UNLIMITED)


@pytest.fixture
def daemon() -> Iterator[FakeDaemon]:
    one = FakeDaemon()
    yield one
    one.close()


@pytest.fixture
def robot(project: Project, daemon: FakeDaemon) -> Iterator[Driven]:
    """The adapter of a robot that sleeps."""
    one = Driven(project, daemon.url)
    yield one
    one.close()


@pytest.fixture
def awake(robot: Driven) -> Driven:
    """The robot after the command `wake`."""
    from lumen.language.commands import Wake

    assert robot.answer("wake", Wake()).name == "done.command.wake"
    return robot
