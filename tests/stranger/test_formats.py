"""A stranger's file format is imported and exported like one of Lumen's, with its table of names."""

from pathlib import Path

import pytest
from scripts.format_tables import written

from lumen.cli.main import main
from lumen.project.formats.importers import endings, format_tables
from lumen.statechart import Machine
from tests import ROOT
from tests.stranger.installing import Installed, Lumen

PROJECT = ROOT / "tests/lint/pages/base"
FAULTY = """
from lumen.feature import Exporter, Feature, Importer

FEATURE = Feature(
    name="faulty",
    importers={".odd": Importer("behavior", "faulty_odd:read"), ".scxml": Importer("behavior", "faulty_odd:read")},
    exporters={"odd": Exporter("behavior", "faulty_odd:write")},
)
"""


@pytest.fixture
def states(tmp_path: Path) -> Path:
    file = tmp_path / "door.states"
    file.write_text("closed knock\n# a comment\nopen leave\n")
    return file


@pytest.mark.process
def test_its_files_are_imported_and_losses_are_listed(stranger: Path, states: Path, capsys) -> None:
    back = states.with_name("door.yaml")
    assert main(["import", str(states), "-o", str(back)]) == 1
    assert f"{states}:2:1 error[not-carried-over] a comment is left out" in capsys.readouterr().err
    machine = Machine.load(back)
    assert [name for name in machine.states if name] == ["closed", "open"]
    assert ".states" in endings("behavior")


@pytest.mark.process
def test_a_behaviour_is_exported_in_a_process(stranger_lumen: Lumen) -> None:
    done = stranger_lumen(PROJECT, "export", "states", "tour")
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.splitlines()[0] == "idle"


@pytest.mark.process
def test_help_and_the_page_of_formats_list_it(stranger: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for words, part in (("import", "The installed package `lumen-stranger` adds .states."), ("export", "| states")):
        with pytest.raises(SystemExit):
            main([words, "--help"])
        assert part in " ".join(capsys.readouterr().out.split())
    assert list(format_tables())[-1] == "lists of states"
    assert "### lists of states" in written("")


@pytest.mark.parametrize("words", [["import", "FILE"], ["export", "odd"]])
def test_one_that_cannot_be_imported_names_its_distribution(
    words: list[str], installed: Installed, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    installed.write("faulty", FAULTY)
    (tmp_path / "a.odd").touch()
    assert main([str(tmp_path / "a.odd") if word == "FILE" else word for word in words]) == 2
    assert "the installed package `faulty` 1.0 is faulty: its module `faulty_odd:" in capsys.readouterr().err


def test_lumens_own_reader_of_an_ending_comes_first(installed: Installed, tmp_path: Path) -> None:
    installed.write("faulty", FAULTY)
    file = tmp_path / "chart.scxml"
    file.write_text('<scxml xmlns="http://www.w3.org/2005/07/scxml"><state id="a"/></scxml>')
    assert main(["import", str(file)]) == 0
