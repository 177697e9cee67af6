"""Random hostile files: saving or importing any of them gives an answer, never a traceback."""

from pathlib import Path
from random import Random

import pytest

from lumen.cli.main import main
from lumen.lint import check_files
from lumen.project.files import read_files
from tests import ROOT
from tests.attack.files import FOREIGN, LARGEST, damaged, foreign_file, project_file
from tests.tables import for_each

BASE = read_files(ROOT / "tests/lint/base")


def test_a_seed_says_what_comes() -> None:
    assert project_file(Random(7), BASE) == project_file(Random(7), BASE)
    assert foreign_file(Random(7)) == foreign_file(Random(7))
    assert all(len(damaged(Random(seed), "a: 1\n")) <= LARGEST for seed in range(100))


@pytest.mark.slow
@pytest.mark.parametrize("batch", range(4))
def test_a_project_with_a_hostile_file_is_judged(batch: int) -> None:
    for seed in range(40 * batch, 40 * batch + 40):
        path, content = project_file(Random(seed), BASE)
        project, found = check_files(Path("/nowhere"), {**BASE, path: content})
        assert project is not None or found, f"seed {seed}: {path}"
        for finding in found:
            assert finding.place.line >= 1
            assert len(finding.message) <= 1_000


@pytest.mark.slow
@pytest.mark.parametrize("batch", range(4))
def test_a_hostile_file_of_another_tool_is_imported_or_a_line(
    batch: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for seed in range(30 * batch, 30 * batch + 30):
        name, content = foreign_file(Random(seed))
        (tmp_path / name).write_bytes(content)
        code = main(["import", str(tmp_path / name), "-o", str(tmp_path / "out.yaml")])
        error = capsys.readouterr().err
        assert code in (0, 1) or error.count("\n") == 1, f"seed {seed}: {error[:500]}"
        assert "Traceback" not in error


@for_each("ending", FOREIGN)
def test_the_sound_file_of_each_kind_is_imported(ending: str, tmp_path: Path) -> None:
    (tmp_path / f"sound.{ending}").write_text(FOREIGN[ending], "utf-8")
    assert main(["import", str(tmp_path / f"sound.{ending}"), "-o", str(tmp_path / "out.yaml")]) in (0, 1)


NINES, HEX = "9" * 5_000, "0x" + "f" * 500
SCXML = "<scxml version='1.0' datamodel='ecmascript'><state id='a'>{}</state></scxml>"
CALL = "names = ['HeadYaw']\ntimes = [[1]]\nkeys = [[{}]]\nx.angleInterpolation(names, times, keys)\n"
NUMBERED = {
    "hex.py": CALL.format("0x" + "f" * 5_000),
    "long.py": CALL.format("9" * 400),
    "time.motion": f"#WEBOTS_MOTION,V1.0,HeadYaw\n{NINES}:00:500,Pose1,0.2\n",
    "angle.motion": "#WEBOTS_MOTION,V1.0,HeadYaw\n00:00:500,Pose1,1e308\n",
    "delay.scxml": SCXML.format(f"<onentry><send event='e' delay='{NINES}s'/></onentry>"),
    "condition.scxml": SCXML.format(f"<transition cond='{HEX} > 1'/>"),
    "delays.scxml": SCXML.format(f"<onentry><send event='e' delay='{NINES * 20}x'/></onentry>"),
    "resolution.fll": FOREIGN["fll"].replace("Centroid 100", "Centroid ²"),
    "numbers.json": f'{{"states": {{"a": {{}}}}, "context": {{"n": {NINES[:400]}}}}}',
}


def blanks(name: str, blank: str) -> str:
    return FOREIGN[name.partition(".")[2]].replace(" ", " " + blank * 100_000, 1)


@pytest.mark.parametrize("name", ["blank.py", "blank.fcl", "blank.fll", "blank.fis", "blank.motion", "blank.scxml"])
@pytest.mark.parametrize("blank", [" ", "\n", "\t"])
def test_hundreds_of_thousands_of_blanks_are_nothing(name: str, blank: str, tmp_path: Path) -> None:
    (tmp_path / name).write_text(blanks(name, blank), "utf-8")
    assert main(["import", str(tmp_path / name), "-o", str(tmp_path / "out.yaml")]) in (0, 1, 2)


@for_each("name", NUMBERED)
def test_numbers_of_thousands_of_digits_are_findings(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / name).write_text(NUMBERED[name], "utf-8")
    assert main(["import", str(tmp_path / name), "-o", str(tmp_path / "out.yaml")]) in (1, 2)
    error = capsys.readouterr().err
    assert "Traceback" not in error
    assert "the result" not in error
