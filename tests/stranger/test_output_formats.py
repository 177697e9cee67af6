"""A stranger's format of findings or of verdicts is chosen by --format; a faulty one names its distribution."""

from pathlib import Path

import pytest

from lumen.cli.main import main
from tests import ROOT
from tests.copying import copied_project
from tests.stranger.installing import Installed

PROJECT = ROOT / "tests/lint/pages/base"
FAULTY = """
from lumen.feature import Feature

FEATURE = Feature(
    name="faulty", finding_formats={"odd": "faulty_odd:findings"}, verdict_formats={"odd": "faulty_odd:verdict"}
)
"""


@pytest.fixture
def played(tmp_path: Path) -> str:
    """A project with a story."""
    return str(copied_project(ROOT / "examples/minimal", tmp_path / "minimal"))


@pytest.mark.process
def test_findings_are_printed_in_it(stranger: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["lint", str(PROJECT), "--format", "count"]) == 0
    assert capsys.readouterr().out == "0 in all\n"


@pytest.mark.process
def test_verdicts_are_printed_in_it(stranger: Path, played: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["test", played, "--format", "count"]) == 0
    assert capsys.readouterr().out == "1 played, 0 failed\n"


def test_one_that_cannot_be_imported_names_its_distribution(
    installed: Installed, played: str, capsys: pytest.CaptureFixture[str]
) -> None:
    installed.write("faulty", FAULTY)
    for words in (["lint", str(PROJECT)], ["test", played]):
        assert main([*words, "--format", "odd"]) == 2
        assert "the installed package `faulty` 1.0 is faulty: its module `faulty_odd:" in capsys.readouterr().err
