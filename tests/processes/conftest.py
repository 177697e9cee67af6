"""Copies of the shipped project with few stories, and exhibitions in parts."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from lumen.robot.remote import robot
from lumen.run import presence
from lumen.run.parts import guard
from tests.processes.troupe import STORIES, Troupe
from tests.rabbitmq import RabbitMQ
from tests.tour.conftest import copy as whole
from tests.tour.conftest import project
from tests.waiting import UNLIMITED

__all__ = ["project", "whole"]


@pytest.fixture
def copy(whole: Path) -> Path:
    folder = whole / "behaviors" / "stories"
    for story in folder.glob("*.yaml"):
        if story.stem != "visitor":
            story.unlink()
    for name, text in STORIES.items():
        (folder / f"{name}.yaml").write_text(text, "utf-8")
    return whole


@pytest.fixture
def troupe(copy: Path, broker: RabbitMQ) -> Iterator[Troupe]:
    """The parts of an exhibition, each with a connection of its own to one broker."""
    one = Troupe(copy, broker.url)
    yield one
    one.close()


@pytest.fixture
def patient(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let no part count as lost, and no command as unanswered, because a slow machine delivers messages late."""
    for module, limit in (
        (presence, "LOST_AFTER"),
        (guard, "LOST_AFTER"),
        (guard, "BRAIN_TIMEOUT"),
        (robot, "COMMAND_ANSWER_TIMEOUT"),
    ):
        monkeypatch.setattr(module, limit, UNLIMITED)
