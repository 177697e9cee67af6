"""Copies of the shipped project, with few stories, and shows of them."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.live.shows import Live
from tests.tour.conftest import copy as whole
from tests.tour.conftest import project

__all__ = ["project", "whole"]


@pytest.fixture
def copy(whole: Path) -> Path:
    for story in (whole / "behaviors" / "stories").glob("*.yaml"):
        if story.stem not in ("refuses", "known_visitor"):
            story.unlink()
    main = whole / "lumen.yaml"
    main.write_text(main.read_text("utf-8").replace("story: visitor", "story: refuses"), "utf-8")
    return whole


@pytest.fixture
def live(copy: Path) -> Iterator[Live]:
    one = Live(copy)
    yield one
    one.show.close()
