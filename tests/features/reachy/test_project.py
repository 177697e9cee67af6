"""The shipped tour, the example and new projects with the body of Reachy Mini, without a robot."""

from math import radians
from pathlib import Path

import pytest

import lumen
from lumen.cli.main import main
from lumen.features.reachy.pose import JOINTS
from lumen.features.reachy.reach import shortfall
from lumen.language.body_parts import WHOLE_BODY
from lumen.language.diagnostics import has_errors
from lumen.language.motions import Keyframe, MotionDefinition
from lumen.language.projects import Project
from lumen.project.chosen_model import MODEL_VARIABLE
from lumen.robot.life_layer import LifeLayer
from lumen.run.rehearsal import rehearse
from tests import ROOT
from tests.copying import copied_project
from tests.scanning import matching

EXAMPLE = ROOT / "examples/reachy"


def test_the_shipped_tour_lints_and_guides_a_visitor(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(MODEL_VARIABLE, "reachy_mini")
    found = lumen.check(ROOT)
    assert not has_errors(found)
    assert {d.code for d in found} == {"left-out", "unused-file"}
    touched = [d.message for d in found if "touch" in d.message]
    assert touched
    assert all(message.startswith("Reachy Mini has no touch sensors") for message in touched)
    project = lumen.load(ROOT)
    assert not rehearse(project, project.stories["visitor"]).failed


@pytest.mark.parametrize("style", ["calm", "lively", "listening"])
def test_on_the_shipped_tour_its_head_breathes_and_leans(style: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(MODEL_VARIABLE, "reachy_mini")
    project = lumen.load(ROOT)
    layer = LifeLayer(project.body)
    layer.style = project.life[style]
    offsets = [dict(layer.advance(tick / 50, 1 / 50, WHOLE_BODY, lambda _part: 1.0)) for tick in range(1_000)]
    heave, roll = ([each.get(joint, 0.0) for each in offsets] for joint in ("head_z", "head_roll"))
    assert 0.006 < max(heave) - min(heave) < 0.0105
    assert max(roll) - min(roll) > radians(4)
    assert not [d for d in lumen.check(ROOT) if "life/" in d.place.file]


def test_the_styles_of_a_robot_are_not_those_of_another(tmp_path: Path) -> None:
    folder = copied_project(EXAMPLE, tmp_path / "host")
    (folder / "motions/reachy_mini/life").mkdir(parents=True)
    calm = (folder / "motions/life/calm.yaml").read_text()
    own = folder / "motions/reachy_mini/life/calm.yaml"
    own.write_text(calm.replace("period: 4.2s", "period: 2s", 1))
    assert lumen.load(folder).life["calm"].sways[0].period == 2.0
    own.write_text(calm.replace("sways:", "sway:", 1))
    assert own.relative_to(folder).as_posix() in {d.place.file for d in lumen.check(folder)}
    own.parent.rename(folder / "motions/reachy_mini/other")
    own.parent.parent.rename(folder / "motions/pepper")
    (folder / "motions/pepper/other").rename(folder / "motions/pepper/life")
    assert lumen.load(folder).life["calm"].sways[0].period == 4.2


def test_the_example_is_sound_and_its_story_passes() -> None:
    assert not lumen.check(EXAMPLE)
    project = lumen.load(EXAMPLE)
    assert not rehearse(project, project.stories["visitor"]).failed
    assert {"head_z", "head_roll"} <= project.life["calm"].amplitudes.keys()


def test_a_robots_own_gestures_replace_those_of_the_same_name(tmp_path: Path) -> None:
    folder = copied_project(ROOT, tmp_path / "tour")
    (folder / "motions/nao/gestures").mkdir(parents=True)
    nod = "{for: beat, stroke: {takes: 400ms, roles: {head.pitch: 0.1}}}"
    own = folder / "motions/nao/gestures/guide.yaml"
    own.write_text(f"gestures: {{dip: {nod}}}\n")
    (own.parent / "more.yaml").write_text(f"gestures: {{dip: {nod.replace('0.1', '9')}}}\n")
    found = [(str(d.place), d.code) for d in lumen.check(folder) if "gestures/" in d.place.file]
    assert found == [("motions/nao/gestures/more.yaml:1:72", "out-of-reach")]
    (own.parent / "more.yaml").unlink()
    gestures = lumen.load(folder).gestures
    assert [gesture.name for gesture in gestures["guide"].gestures] == ["dip"]
    own.parent.parent.rename(folder / "motions/pepper/nao")
    assert len(lumen.load(folder).gestures["guide"].gestures) > 20


def test_the_motions_of_the_example_are_the_shipped_ones() -> None:
    for file in matching(EXAMPLE / "motions", "*.yaml"):
        shipped = (ROOT / "motions/reachy_mini" / file.name).read_text()
        assert file.read_text().partition("\n")[2] == shipped.partition("\n")[2], file.name


def test_a_new_project_has_its_motions(tmp_path: Path) -> None:
    assert main(["new", str(tmp_path / "show"), "--robot", "reachy_mini"]) == 0
    project = lumen.load(tmp_path / "show")
    assert project.body.name == "Reachy Mini"
    assert {"greet", "nod", "shake", "dance", "sing", "goodbye", "curious", "sleepy"} <= project.motions.keys()


def test_lint_names_a_pose_beyond_the_rods(tmp_path: Path) -> None:
    folder = copied_project(EXAMPLE, tmp_path / "host")
    file = folder / "motions/greet.yaml"
    file.write_text(file.read_text().replace("head_z: 12, head_pitch: -14", "head_z: 22, head_pitch: -30"))
    [finding] = [d for d in lumen.check(folder) if d.code == "beyond-rods"]
    assert finding.place.file == "motions/greet.yaml"
    assert "its rods let `head_" in finding.message


def test_a_motion_says_where_it_falls_short(project: Project) -> None:
    tracks = {"head_z": (Keyframe(1.0, 0.022),), "head_pitch": (Keyframe(1.0, 0.6), Keyframe(2.0, 0.0))}
    short = shortfall(MotionDefinition("far", 2.0, tracks), project.body)
    assert short.startswith("`far` falls short at ")
    assert set(project.body.joints) == set(JOINTS)
