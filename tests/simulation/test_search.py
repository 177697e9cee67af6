"""The search for passages: what it varies, and that it can tell a good one from a bad one."""

from pathlib import Path

import pytest
from search_passage import Text, Trial, cost

from lumen.language.robots import Body
from lumen.motion import Motion
from tests.simulation.conftest import MODELS

PASSAGES = sorted((MODELS / "passages").glob("*.yaml"))


@pytest.mark.parametrize("path", PASSAGES, ids=lambda path: path.stem)
def test_its_numbers_written_again_are_the_file(body: Body, path: Path) -> None:
    text = Text(path.read_text("utf-8"), body)
    assert text.written(text.numbers) == path.read_text("utf-8")
    changed = text.written([number + 500 for number in text.numbers[: text.angles]] + text.numbers[text.angles :])
    assert "LKneePitch: 121" in changed


@pytest.mark.slow
def test_a_passage_that_ends_elsewhere_costs_more(body: Body) -> None:
    path = MODELS / "passages/sitrelax-straddle.yaml"
    text = Text(path.read_text("utf-8"), body)
    trials = [Trial(body, MODELS, Motion.load(path), seed=1)]
    good = cost(text.written(text.numbers), trials, body)
    bad = cost(text.written([0.0] * text.angles + text.numbers[text.angles :]), trials, body)
    assert good < 0.3 < bad
    assert good == cost(text.written(text.numbers), trials, body)
