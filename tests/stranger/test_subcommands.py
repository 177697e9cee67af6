"""A stranger's subcommand is listed, completed and run like one of Lumen's; a faulty one names its distribution."""

import re
from pathlib import Path

import pytest

from lumen.cli.main import main
from lumen.lint import check_files
from lumen.project.files import read_files
from tests import ROOT
from tests.stranger.installing import Installed, Lumen

PROJECT = ROOT / "tests/lint/pages/base"
MANIFEST = """
from lumen.feature import Feature, Subcommand

FEATURE = Feature(name="faulty", subcommands={"wave": Subcommand("wave", "faulty_wave"), "lint": Subcommand("x", "y")})
"""


@pytest.mark.process
def test_it_is_listed_where_it_wants_to_be(stranger: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([]) == 2
    names = re.findall(r"(?m)^    ([\w-]+)  ", capsys.readouterr().out)
    assert names[names.index("plot") + 1 :] == ["greet", "import", "export"]


@pytest.mark.process
def test_it_runs_in_a_process_with_its_options(stranger_lumen: Lumen) -> None:
    done = stranger_lumen(PROJECT, "greet", str(PROJECT), "--loud")
    assert (done.returncode, done.stdout, done.stderr) == (0, "WELCOME TO SMALL!\n", "")
    assert "use capital letters" in stranger_lumen(PROJECT, "greet", "--help").stdout


@pytest.mark.process
def test_it_and_its_options_are_completed(stranger: Path, capsys: pytest.CaptureFixture[str]) -> None:
    def completed(*words: str) -> list[str]:
        assert main(["completion", "words", "--", *(f".{word}" for word in words)]) == 0
        return [line.partition("\t")[0] for line in capsys.readouterr().out.splitlines()]

    assert completed("gr") == ["graph", "greet"]
    assert "--loud" in completed("greet", "--")


@pytest.mark.parametrize("module", ["1 / 0", "import not_installed", "", "def configure(parser):\n    1 / 0\n"])
def test_one_that_cannot_be_imported_names_its_distribution(
    module: str, installed: Installed, capsys: pytest.CaptureFixture[str]
) -> None:
    installed.write("faulty", MANIFEST, faulty_wave=module)
    assert main(["wave"]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("lumen wave: the installed package `faulty` 1.0 is faulty: its module `faulty_wave` raised ")
    assert main(["explain", "cut-short"]) == 0


@pytest.mark.process
def test_a_package_that_cannot_be_loaded_is_named(installed: Installed, capsys: pytest.CaptureFixture[str]) -> None:
    installed.write("faulty", "1 / 0")
    named = "(not loaded, because of faults that `lumen lint` reports: faulty 1.0)"
    for words, code in ((["wave"], 2), (["--help"], 0)):
        with pytest.raises(SystemExit) as left:
            main(words)
        assert left.value.code == code
        assert named in " ".join("".join(capsys.readouterr()).split())


def test_one_with_the_name_of_another_is_ignored_and_reported(installed: Installed) -> None:
    installed.write("faulty", MANIFEST, faulty_wave="")
    assert main(["lint", str(PROJECT), "--strict"]) == 1
    (finding,) = check_files(PROJECT, read_files(PROJECT))[1]
    assert finding.code == "broken-feature"
    assert finding.message == (
        "the installed package `faulty` 1.0 is faulty: "
        "its row `lint` of `subcommands` is ignored: the feature `core` has that name"
    )
