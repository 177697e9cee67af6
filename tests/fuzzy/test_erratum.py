"""The example with the paper's tables as printed: a whole project, wrong in the ways its README says."""

from pathlib import Path

import pytest

import lumen
from lumen.fuzzy import Controller
from lumen.language.diagnostics import has_errors
from lumen.lint import check_files
from lumen.motion.tracking import Tracker
from lumen.project.files import read_files
from tests.fuzzy.nao import HEAD
from tests.tables import for_each

PROJECT = "examples/erratum"


@pytest.fixture(scope="module")
def printed() -> Controller:
    return Controller.load(f"{PROJECT}/fuzzy/head.yaml")


def test_it_is_a_whole_project() -> None:
    assert not has_errors(lumen.check(PROJECT)), [str(d) for d in lumen.check(PROJECT)]


def test_lint_tells_what_is_wrong_with_it() -> None:
    found = [(d.code, d.place.line, d.message) for d in lumen.check(PROJECT)]
    assert [code for code, _, _ in found] == [
        "term-order", "not-at-rest", "not-monotone", "term-order", "not-at-rest", "not-monotone", "wrong-sign",
        "term-order",
    ]  # fmt: skip
    assert [message for code, _, message in found if code in ("not-at-rest", "not-monotone")] == [
        "at rest, with `FaceXLoc` at 160, `AngleX` is 5.97 instead of 0",
        "`AngleX` rises until `FaceXLoc` is 160, and then falls",
        "at rest, with `FaceYLoc` at 120, `AngleY` is -2.07 instead of 0",
        "`AngleY` falls until `FaceYLoc` is 120, and then rises",
    ]


@pytest.mark.parametrize("gain", [1, -1])
def test_with_the_numbers_put_right_only_the_sign_is_left(gain: int) -> None:
    files = read_files(Path(PROJECT))
    text = files["fuzzy/head.yaml"].decode()
    for right, wrong in (("240, 70", "120, 40"), ("15, 10", "0, 10"), ("7, 6", "0, 6")):
        text = text.replace(f"Positive: {{gaussian: [{wrong}]", f"Positive: {{gaussian: [{right}]")
        text = text.replace(f"Zero: {{gaussian: [{right}]", f"Zero: {{gaussian: [{wrong}]")
    text = text.replace("joint: HeadPitch, gain: 1", f"joint: HeadPitch, gain: {gain}")
    found = check_files(Path(PROJECT), {**files, "fuzzy/head.yaml": text.encode()})[1]
    assert [d.code for d in found] == ["wrong-sign"] * (1 if gain > 0 else 2)


@for_each(
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
