"""The search for passages: what it varies, and that it can tell a good one from a bad one."""

from pathlib import Path

import pytest
from search_passage import KeptCosts, Text, Trial, cost, cost_of

from lumen.language.robots import Body
from lumen.motion import Motion
from lumen.project.files import read_files
from lumen.run.workers.tasks import WorkKit, models_in
from lumen.run.workers.workers import Workers
from tests.features.simulation.conftest import MODELS
from tests.scanning import matching
from tests.tables import for_each

PASSAGES = matching(MODELS / "passages", "*.yaml")


@for_each("path", PASSAGES, ids=lambda path: path.stem)
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


@pytest.mark.soak
def test_two_processes_find_the_costs_that_one_finds() -> None:
    """Each process loads the project and stands a robot up, which takes seconds."""
    passage, root = (MODELS / "passages/sitrelax-straddle.yaml").read_text("utf-8"), MODELS.parent
    kit = WorkKit({"": read_files(root)}, models_in(root))
    tasks = [(text, passage, 1, 1) for text in (passage, passage.replace("at: 1", "at: 2"))]
    alone = list(Workers(1).results(cost_of, kit, tasks))
    assert sorted(Workers(2).results(cost_of, kit, tasks)) == alone


def test_what_was_computed_is_kept_by_what_it_hangs_on(tmp_path: Path) -> None:
    asked: list[str] = []

    def compute(texts: list[str]) -> list[tuple[int, float]]:
        asked.extend(texts)
        return [(number, float(len(text))) for number, text in reversed(list(enumerate(texts)))]

    assert KeptCosts(tmp_path, "one").of(["a", "bb", "a"], compute) == [1.0, 2.0, 1.0]
    (file,) = tmp_path.iterdir()
    file.write_text(file.read_text() + '["torn')
    assert KeptCosts(tmp_path, "one").of(["bb", "ccc"], compute) == [2.0, 3.0]
    assert KeptCosts(tmp_path, "one").of(["ccc", "a"], compute) == [3.0, 1.0]
    assert KeptCosts(tmp_path, "other").of(["a"], compute) == [1.0]
    assert asked == ["a", "bb", "ccc", "a"]
