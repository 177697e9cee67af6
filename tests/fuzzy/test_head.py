"""The shipped head controller: the numbers of Tables 1 and 2, to 1e-3 deg."""

import sys

import numpy as np
import pytest

from lumen.errors import ProjectError, UsageError
from lumen.fuzzy import Controller
from tests.guarded import run_guarded
from tests.tables import for_each

YAW = {0: 7.088, 80: 2.843, 160: 0.0, 240: -2.843, 320: -7.088}
PITCH = {0: 2.438, 60: 1.234, 120: 0.0, 180: -1.234, 240: -2.438}


@pytest.fixture(scope="module")
def head() -> Controller:
    return Controller.load("fuzzy/head.yaml")


@for_each("x", YAW)
def test_yaw(head: Controller, x: int) -> None:
    assert head.evaluate({"FaceXLoc": x, "FaceYLoc": 120})["AngleX"] == pytest.approx(YAW[x], abs=1e-3)


@for_each("y", PITCH)
def test_pitch(head: Controller, y: int) -> None:
    assert head.evaluate({"FaceXLoc": 160, "FaceYLoc": y})["AngleY"] == pytest.approx(PITCH[y], abs=1e-3)


def test_a_batch_says_what_single_evaluations_say(head: Controller) -> None:
    rng = np.random.default_rng(1)
    xs, ys = rng.uniform(-50, 370, 300), rng.uniform(-50, 290, 300)
    batch = head.evaluate_batch({"FaceXLoc": xs, "FaceYLoc": ys})
    single = [head.evaluate({"FaceXLoc": x, "FaceYLoc": y}) for x, y in zip(xs, ys, strict=True)]
    for name in ("AngleX", "AngleY"):
        assert batch[name].shape == (300,)
        assert batch[name] == pytest.approx([outputs[name] for outputs in single], abs=1e-12)


def test_the_middle_is_flat_for_45_pixels(head: Controller) -> None:
    """Min-max and the centroid have this result with the paper's tables; therefore the tracker magnifies."""
    assert head.evaluate({"FaceXLoc": 205, "FaceYLoc": 120})["AngleX"] == pytest.approx(0.0, abs=0.01)
    assert abs(head.evaluate({"FaceXLoc": 225, "FaceYLoc": 120})["AngleX"]) > 0.5


def test_explain_shows_every_number(head: Controller) -> None:
    said = head.explain({"FaceXLoc": 80, "FaceYLoc": 120})
    assert said.memberships["FaceXLoc"] == pytest.approx(
        {"Negative": 0.60653, "Zero": 0.27804, "Positive": 0.01111}, abs=1e-5
    )
    assert [round(degree, 3) for _, degree in said.rules] == [0.607, 0.278, 0.011, 0.23, 1.0, 0.23]
    yaw = said.outputs["AngleX"]
    assert yaw.value == pytest.approx(2.843, abs=1e-3)
    centroid = np.average(yaw.points, weights=yaw.memberships)
    assert centroid == pytest.approx(yaw.value)


def test_where_nothing_fires_the_default_stands(head: Controller) -> None:
    assert head.evaluate({"FaceXLoc": 1e6, "FaceYLoc": 120})["AngleX"] == 0.0
    assert not head.explain({"FaceXLoc": 1e6, "FaceYLoc": 120}).outputs["AngleX"].fired


@pytest.mark.parametrize(
    ("inputs", "message"),
    [
        ({"FaceXLoc": 1.0}, "`FaceYLoc` of `head` is missing"),
        ({"FaceXLoc": 1.0, "FaceYLoc": 2.0, "FaceZLoc": 3.0}, "no input `FaceZLoc`: did you mean"),
        ({"FaceXLoc": float("nan"), "FaceYLoc": 2.0}, "not a number"),
        ({"FaceXLoc": "left", "FaceYLoc": 2.0}, "must be numbers"),
    ],
)
def test_wrong_inputs_are_named(head: Controller, inputs: dict[str, float], message: str) -> None:
    with pytest.raises(UsageError, match=message):
        head.evaluate(inputs)


def test_wrong_batches_are_named(head: Controller) -> None:
    with pytest.raises(UsageError, match="the same shape"):
        head.evaluate_batch({"FaceXLoc": [1.0, 2.0], "FaceYLoc": [1.0]})
    with pytest.raises(UsageError, match="not numbers"):
        head.evaluate_batch({"FaceXLoc": [float("nan")], "FaceYLoc": [1.0]})
    with pytest.raises(UsageError, match="missing"):
        head.evaluate_batch({"FaceXLoc": [1.0]})
    assert head.evaluate_batch({"FaceXLoc": [], "FaceYLoc": []})["AngleX"].shape == (0,)


def test_a_missing_file_and_a_wrong_one_say_so(tmp_path_factory: pytest.TempPathFactory) -> None:
    with pytest.raises(UsageError, match="can't read"):
        Controller.load("fuzzy/haed.yaml")
    file = tmp_path_factory.mktemp("fuzzy") / "broken.yaml"
    file.write_text("inputs: [")
    with pytest.raises(ProjectError, match="yaml-syntax"):
        Controller.load(file)
    file.write_text("inputs: {x: {range: [0, 1]}}\n")
    with pytest.raises(ProjectError, match="missing-key"):
        Controller.load(file)


@pytest.mark.slow
def test_loading_and_one_evaluation_need_no_numpy() -> None:
    code = (
        "import sys; from lumen.fuzzy import Controller; c = Controller.load('fuzzy/head.yaml');"
        "c.evaluate({'FaceXLoc': 80, 'FaceYLoc': 60}); sys.exit('numpy' in sys.modules)"
    )
    assert run_guarded([sys.executable, "-c", code], check=False).returncode == 0
