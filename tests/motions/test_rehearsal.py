"""`lumen lint --physics`: the ways that lead to a motion, and stored results. Tests of pages have its findings."""

import shutil
from pathlib import Path

import pytest

import lumen
from lumen.cli.main import main
from lumen.features.simulation.trials.cases import Case, cases
from lumen.features.simulation.trials.outcome_cache import OutcomeCache
from lumen.features.simulation.trials.trial import DONE, FELL, CaseResult, Outcome
from lumen.features.simulation.trials.verdict import findings
from lumen.project.chosen_model import MODEL_VARIABLE
from tests import ROOT
from tests.motions.making import SHIPPED


def test_every_motion_and_every_passage_is_a_case() -> None:
    project = lumen.load(ROOT)
    found = cases(project)
    played = [case for case in found if not (case.passage or case.living)]
    assert {case.motion.name for case in played} == set(SHIPPED)
    passages = project.body.passages
    assert [(case.motion, case.way) for case in found if case.passage] == [(p, f"from {p.start}") for p in passages]
    assert all(case.way == "from Stand" for case in played)
    assert {case.file for case in found if case.living} == {f"motions/life/{name}.yaml" for name in project.life}


@pytest.mark.parametrize("model", ["nao", "sprout", "greeter"])
def test_a_fall_is_found_where_this_robots_own_file_moves_its_legs(model: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """It is in the file that this robot plays, at the keyframe that moves a leg; without legs, at the next one."""
    monkeypatch.setenv(MODEL_VARIABLE, model)
    project = lumen.load(ROOT)
    case = next(case for case in cases(project) if case.motion.name == "dance")
    assert case.file == ("motions/dance.yaml" if model == "nao" else f"motions/{model}/dance.yaml")
    assert {case.file for case in cases(project)} <= project.documents.keys()
    legs = {role.joint for leg in project.body.roles.legs.values() for role in leg.values()}
    tracks = case.motion.tracks
    assert bool(legs) == (model != "greeter")
    moved = [keys for name, keys in tracks.items() if name in legs] or list(tracks.values())
    at = sorted(key.time for keys in moved for key in keys)[len(moved)]
    (found,) = findings(CaseResult(case, [Outcome(FELL, at, 60.0, at)]), project.documents[case.file], project.body)
    assert found.place.file == case.file
    coming = min((key for keys in moved for key in keys if key.time >= at - 1e-9), key=lambda key: key.time)
    where = coming.where[: max(i for i, step in enumerate(coming.where) if step == "keyframes") + 2]
    assert found.place.line == project.documents[case.file].place(where).line


def project_in(folder: Path) -> None:
    """Copy the shipped project there."""
    for name in ("models", "motions", "behaviors", "functions", "fuzzy", "schemas"):
        shutil.copytree(ROOT / name, folder / name)
    shutil.copy(ROOT / "lumen.yaml", folder)


SWINGING = """units: {angle: deg}
sways:
  hands: {period: 2s, joints: {LHand: 0.1}}
  all:
    period: 5s
    joints:
      {LHipPitch: 2.8, RHipPitch: -2.8, LAnklePitch: 2.8, RAnklePitch: -2.8, LHipYawPitch: 2.8,
       LHipRoll: 2.8, RHipRoll: 2.8, LAnkleRoll: 2.8, RAnkleRoll: 2.8}
"""


@pytest.mark.slow
@pytest.mark.physics
def test_a_style_that_could_tip_the_robot_is_found_at_its_sway(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    project_in(tmp_path)
    monkeypatch.chdir(tmp_path)
    style = Path("motions", "life", "calm.yaml")
    style.write_text(SWINGING)
    main(["lint", str(style), "--physics", "--robots", "0", "--format", "concise"])
    found = capsys.readouterr().out
    assert "motions/life/calm.yaml:4:3: warning[unsteady] the torso leans" in found
    assert "when the robot lives like this" in found


BOWING = """start: Stand
units: {angle: deg}
return: 1s
keyframes:
  - {at: 500ms, joints: {head_yaw: 5}}
  - {at: 900ms, joints: {left_hip_pitch: -80, right_hip_pitch: -80}}
"""


@pytest.mark.slow
@pytest.mark.physics
def test_a_motion_of_one_robot_is_played_by_it_and_found_in_its_file(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    project_in(tmp_path)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv(MODEL_VARIABLE, "sprout")
    motion = Path("motions", "sprout", "goodbye.yaml")
    motion.write_text(BOWING)
    assert main(["lint", str(motion), "--physics", "--robots", "0", "--format", "concise"]) == 1
    assert "motions/sprout/goodbye.yaml:6:5: error[falls] the robot falls here" in capsys.readouterr().out


def test_a_robot_that_falls_as_it_lives_falls_at_its_sway() -> None:
    project = lumen.load(ROOT)
    case = next(case for case in cases(project) if case.file == "motions/life/lively.yaml")
    (found,) = findings(CaseResult(case, [Outcome(FELL, 3.0, 60.0, 3.0)]), project.documents[case.file], project.body)
    assert found.code == "falls"
    assert "at 3.0 s, when it lives like this" in found.message
    assert found.place.line == project.documents[case.file].place(("sways", "weight"), key=True).line
    assert not findings(CaseResult(case, [Outcome(DONE, 20.0, 3.0, 3.0)]), project.documents[case.file], project.body)


@pytest.mark.slow
def test_what_is_known_is_kept_and_damage_is_as_good_as_nothing(tmp_path: Path) -> None:
    project_in(tmp_path)
    project = lumen.load(tmp_path)
    case: Case = cases(project)[0]
    outcome = Outcome(DONE, 1.0, 2.0, 0.5, slid={"L": (0.1, 0.002)})
    OutcomeCache(project, {}).keep(case, {0: outcome})
    assert OutcomeCache(project, {}).recall(case) == {0: outcome}
    (file,) = (tmp_path / ".lumen" / "physics").iterdir()
    for text in ("", "[]", '{"0": 5}', '{"x": {}}', '{"0": {"answer": "done"}}'):
        file.write_text(text)
        assert OutcomeCache(project, {}).recall(case) == {}


@pytest.mark.parametrize(
    "options",
    [
        ["--robots", "3"],
        ["--physics", "--robots", "-1"],
        ["--physics", "--robots", "9" * 5_000],
        ["--physics", "--watch"],
    ],
)
def test_options_that_make_no_sense_are_refused(options: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["lint", str(ROOT), *options]) == 2
    assert len(capsys.readouterr().err.strip().splitlines()) == 1
