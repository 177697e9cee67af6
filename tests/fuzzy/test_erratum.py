"""The example with the paper's tables as printed: a whole project, wrong in the ways its README says."""

import pytest

import lumen
from lumen.fuzzy import Controller
from lumen.interpreters.tracking import Tracker
from lumen.language.diagnostics import has_errors
from tests.fuzzy.nao import HEAD

PROJECT = "examples/erratum"


@pytest.fixture(scope="module")
def printed() -> Controller:
    return Controller.load(f"{PROJECT}/fuzzy/head.yaml")


def test_it_is_a_whole_project() -> None:
    assert not has_errors(lumen.check(PROJECT)), [str(d) for d in lumen.check(PROJECT)]


@pytest.mark.parametrize(
    ("x", "y", "angle_x", "angle_y"),
    [(0, 0, 0, 0), (80, 60, 0, 0), (160, 120, 5.966, -2.068), (240, 180, -2.843, 1.234), (320, 240, -7.088, 2.438)],
)
def test_the_readme_tells_the_numbers(printed: Controller, x: int, y: int, angle_x: float, angle_y: float) -> None:
    outputs = printed.evaluate({"FaceXLoc": x, "FaceYLoc": y})
    assert outputs == pytest.approx({"AngleX": angle_x, "AngleY": angle_y}, abs=1e-3)


def test_a_centred_face_turns_the_head_away(printed: Controller) -> None:
    tracker = Tracker(printed, HEAD)
    tracker.pose(0.0, {"HeadYaw": 0.0, "HeadPitch": 0.0})
    target = tracker.see({"x": 160, "y": 120}, 0.0)
    assert target is not None
    assert target["HeadYaw"] == pytest.approx(0.1041, abs=1e-4)
