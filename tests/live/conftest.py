"""Copies of the shipped project, with few stories, and shows of them."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.live.shows import Live
from tests.tour.conftest import copy as whole
from tests.tour.conftest import project

__all__ = ["project", "whole"]

PATIENT = "2h"
"""The time that the guide waits for a visitor: at 20× speed, slow validation of files must not end the wait."""


@pytest.fixture
def copy(whole: Path) -> Path:
    return trimmed(whole)


def trimmed(whole: Path) -> Path:
    """Leave few stories in the copy, and a patient guide; return the copy."""
    for story in (whole / "behaviors" / "stories").glob("*.yaml"):
        if story.stem not in ("refuses", "known_visitor"):
            story.unlink()
    wait_for_visitors(whole, "30s", PATIENT)
    main = whole / "lumen.yaml"
    main.write_text(main.read_text("utf-8").replace("story: visitor", "story: refuses"), "utf-8")
    return whole


def wait_for_visitors(whole: Path, before: str, after: str) -> None:
    """Change how long the guide waits for a visitor, in every state that says goodbye after so long."""
    tour = whole / "behaviors" / "tour.yaml"
    text = tour.read_text("utf-8")
    for target in ("goodbye", '"#goodbye"'):
        assert f"after: {{{before}: {target}}}" in text
        text = text.replace(f"after: {{{before}: {target}}}", f"after: {{{after}: {target}}}")
    tour.write_text(text, "utf-8")


@pytest.fixture
def live(copy: Path) -> Iterator[Live]:
    one = Live(copy)
    yield one
    one.close()
