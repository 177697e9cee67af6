"""`lumen lint --physics`: which ways lead to a motion, and what is kept. What it finds is tested with the pages."""

import shutil
from pathlib import Path

import pytest

import lumen
from lumen.app.lint.outcome_cache import OutcomeCache
from lumen.cli.main import main
from lumen.rules.physics import DONE, Case, Outcome
from lumen.rules.physics.cases import cases
from tests.motions.making import ROOT, SHIPPED


def test_every_motion_and_every_passage_is_a_case() -> None:
    project = lumen.load(ROOT)
    found = cases(project)
    assert {case.motion.name for case in found if not case.passage} == set(SHIPPED)
    assert [case.motion for case in found if case.passage] == list(project.body.passages)
    assert all(case.way == "from Stand" for case in found if not case.passage)


@pytest.mark.slow
def test_what_is_known_is_kept_and_damage_is_as_good_as_nothing(tmp_path: Path) -> None:
    for name in ("models", "motions", "behaviors", "fuzzy", "schemas"):
        shutil.copytree(ROOT / name, tmp_path / name)
    shutil.copy(ROOT / "lumen.yaml", tmp_path)
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
