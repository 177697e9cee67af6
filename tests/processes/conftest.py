"""Copies of the shipped project with few stories, and exhibitions in parts."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.processes.troupe import STORIES, Troupe
from tests.rabbitmq import RabbitMQ
from tests.tour.conftest import copy as whole
from tests.tour.conftest import project

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
