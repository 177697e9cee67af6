"""One line of `behaviors/tour.yaml` changes, and the run changes; no Python is touched."""

from pathlib import Path

import pytest

import lumen
from tests.tour.playing import Run, play

GLAD = "That is good to hear, {{ context.title_en }}."


@pytest.fixture
def changed(copy: Path):  # type: ignore[no-untyped-def]
    """A function that plays the shipped story on a project in whose tour a line was replaced."""
    tour = copy / "behaviors" / "tour.yaml"

    def replay(old: str, new: str) -> Run:
        text = tour.read_text("utf-8")
        assert text.count(old) == 1
        tour.write_text(text.replace(old, new), "utf-8")
        project = lumen.load(copy)
        return play(project, project.stories["visitor"])

    return replay


@pytest.mark.slow
def test_another_text(changed) -> None:  # type: ignore[no-untyped-def]
    run = changed(f'[I am glad to hear that., "{GLAD}"]', "[What a splendid day!]")
    assert run.failure == ""
    assert "What a splendid day!" in [text for _, text in run.said]


def test_another_target(changed) -> None:  # type: ignore[no-untyped-def]
    run = changed('                  fine: "#fine"\n', '                  fine: "#offer"\n')
    assert "fine" not in run.guide()
    assert "expected" in run.failure
    assert "`fine`" in run.failure


def test_another_motion(changed) -> None:  # type: ignore[no-untyped-def]
    run = changed("- {play: dance}", "- {play: photo}")
    assert run.played[0] == "photo"
    assert "dance" not in run.played
    assert "expected" in run.failure
