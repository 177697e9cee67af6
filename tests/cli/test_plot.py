"""`lumen plot`: the values in its drawings, and an image that is not blank."""

import io
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import lumen
from lumen.cli.main import main
from lumen.fuzzy import Controller
from lumen.motion import Motion
from lumen.project.formats.plots import controller_sheet, draw, explained_sheet, motion_sheet
from tests import ROOT
from tests.tables import for_each

pytestmark = pytest.mark.rest  # expensive

HEAD = "fuzzy/head.yaml"
SEVERAL = {
    "inputs": {
        "A": {"range": [0, 1], "terms": {"Low": {"triangle": [-1, 0, 1]}, "High": {"ramp": [0.5, 1]}}},
        "B": {"range": [0, 1], "terms": {"Low": {"triangle": [-1, 0, 0.4]}}},
        "C": {"range": [0, 1], "terms": {"Low": {"ramp": [1, 0]}}},
    },
    "outputs": {
        "Two": {"range": [0, 1], "default": 0, "terms": {"Some": {"triangle": [0, 0.2, 1]}, "More": {"ramp": [0, 1]}}},
        "Three": {
            "range": [-9, 9],
            "default": 0,
            "defuzzifier": "weighted-average",
            "terms": {"One": {"constant": 1}, "Sum": {"linear": [1, 1, 1, 0]}},
        },
    },
    "rules": [
        "if A is Low and B is Low then Two is Some",
        "if A is High then Two is More",
        "if A is Low and B is Low and C is Low then Three is One",
    ],
}


@pytest.fixture(scope="module")
def head() -> Controller:
    return Controller.load(HEAD)


def test_a_sheet_shows_every_variable_and_every_answer(head: Controller) -> None:
    sheet = controller_sheet(head)
    assert [panel.title for panel in sheet.panels] == [
        "FaceXLoc", "FaceYLoc", "AngleX", "AngleY", "AngleX by FaceXLoc", "AngleY by FaceYLoc"
    ]  # fmt: skip
    x = sheet.panels[0]
    assert (x.x.label, x.x.low, x.x.high) == ("FaceXLoc [px], to the right", 0, 320)
    assert [(mark.at, mark.label) for mark in x.marks] == [(160, "neutral")]
    assert [(line.label, line.style, len(line.xs)) for line in x.lines] == [
        ("Negative", 0, 321),
        ("Zero", 1, 321),
        ("Positive", 2, 321),
    ]
    assert x.lines[0].ys[80] == pytest.approx(math.exp(-0.5))
    curve = sheet.panels[4].lines[0]
    assert curve.ys[80] == pytest.approx(head.evaluate({"FaceXLoc": 80, "FaceYLoc": 120})["AngleX"])


@pytest.mark.process
@pytest.mark.slow
def test_two_inputs_are_a_surface_and_three_are_slices() -> None:
    sheet = controller_sheet(Controller.from_dict(SEVERAL))
    titles = [panel.title for panel in sheet.panels]
    assert titles[5:] == [
        "Two by A and B",
        "Three at B = 0.5, C = 0.5",
        "Three at A = 0.5, C = 0.5",
        "Three at A = 0.5, B = 0.5",
    ]
    surface = sheet.panels[5].surface
    assert surface
    assert surface.zs[0][0] == pytest.approx(0.4, abs=0.01)
    assert math.isnan(surface.zs[-1][0]), "no rule fires where A and B are"
    assert "no rule fires" in sheet.note
    assert draw(replace(sheet, panels=sheet.panels[5:7]), ".png")


def test_one_evaluation_shows_rules_sets_and_values(head: Controller) -> None:
    sheet = explained_sheet(head, head.explain({"FaceXLoc": 80, "FaceYLoc": 120}))
    bars = sheet.panels[2].bars
    assert bars
    assert bars.labels[0] == "if FaceXLoc is Negative then AngleX is Positive"
    assert bars.values[0] == pytest.approx(0.60653, abs=1e-5)
    yaw = sheet.panels[3]
    assert yaw.title == "AngleX = 2.843 deg"
    assert yaw.lines[0].filled
    assert yaw.marks[0].at == pytest.approx(2.843, abs=1e-3)
    nothing = explained_sheet(head, head.explain({"FaceXLoc": 1e6, "FaceYLoc": 120}))
    assert nothing.panels[3].title == "AngleX = 0.000 deg: no rule fires"


def test_a_motion_shows_keys_and_limits() -> None:
    body, motion = lumen.load(".").body, Motion.load("motions/goodbye.yaml")
    panels = {panel.title: panel for panel in motion_sheet(motion, body).panels}
    elbow, hand = panels["RElbowRoll"], panels["RHand"]
    assert [round(mark.at, 1) for mark in elbow.marks] == [2.0, 88.5]
    assert elbow.lines[1].points
    assert elbow.lines[1].xs == tuple(key.time for key in motion.tracks["RElbowRoll"])
    assert max(hand.lines[0].ys) == pytest.approx(1.0)


@pytest.mark.slow
def test_the_image_is_there_and_not_blank(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["plot", str(ROOT / HEAD)]) == 0
    assert capsys.readouterr().out == f"wrote {tmp_path / 'head.png'}\n"
    pixels = np.asarray(Image.open("head.png").convert("L"))
    assert pixels.std() > 10
    assert pixels.shape[0] > 300


@pytest.mark.slow
def test_the_text_of_an_svg_is_text(tmp_path: Path, head: Controller) -> None:
    file = tmp_path / "at.svg"
    assert main(["plot", HEAD, "--at", "FaceXLoc=80", "FaceYLoc=120", "-o", str(file)]) == 0
    text = file.read_text("utf-8")
    for word in ("Negative", "Zero", "Positive", "FaceXLoc [px], to the right", "if FaceXLoc is Negative"):
        assert word in text
    small = replace(controller_sheet(head), panels=controller_sheet(head).panels[:1])
    assert draw(small, ".svg") == draw(small, ".svg")


@pytest.mark.slow
def test_any_name_can_be_drawn(head: Controller) -> None:
    sheet = replace(controller_sheet(head), title=r"$\frac{ 50 % of $ äöü", panels=controller_sheet(head).panels[:1])
    assert Image.open(io.BytesIO(draw(sheet, ".png"))).size[0] > 0


@for_each(
    ("arguments", "words"),
    [
        (["fuzzy/haed.yaml"], "did you mean `fuzzy/head.yaml`?"),
        ([HEAD, "-o", "head.gif"], "must end in .png or .svg"),
        ([HEAD, "-o", "/no/such/folder/x.png"], "can't write"),
        ([HEAD, "--at", "FaceXLoc=left", "FaceYLoc=1"], "write an input and a number, such as FaceXLoc=80"),
        ([HEAD, "--at", "FaceXLoc=1"], "`FaceYLoc` of `head` is missing"),
        ([HEAD, "--at", "FaceXLoc=1", "FaceYLoc=1", "Face=1"], "no input `Face`"),
        ([HEAD, "--at", "FaceXLoc=nan", "FaceYLoc=1"], "must be a number, not nan"),
        (["motions/dance.yaml", "--at", "x=1"], "--at is for controllers"),
    ],
)
def test_mistakes_are_one_line(arguments: list[str], words: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["plot", *arguments]) == 2
    error = capsys.readouterr().err
    assert words in error
    assert error.count("\n") == 1
