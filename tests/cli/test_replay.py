"""`lumen replay` of the last run, of a day, and with other files."""

import json
from datetime import date
from pathlib import Path

import pytest

import lumen
from lumen.cli.main import main
from tests import ROOT
from tests.copying import copied_project


@pytest.fixture
def played(tmp_path: Path) -> Path:
    """The folder of a small exhibition after a visit."""
    folder = copied_project(ROOT / "examples/minimal", tmp_path / "minimal")
    (story,) = lumen.load(folder).stories
    with lumen.open(folder, story=story) as exhibition:
        exhibition.run()
    return folder


def replayed(folder: Path, capsys: pytest.CaptureFixture[str], *words: str) -> tuple[int, dict[str, object]]:
    capsys.readouterr()
    code = main(["replay", "--project", str(folder), "--format", "json", *words])
    return code, json.loads(capsys.readouterr().out)


def test_the_last_run_is_the_same_again_and_other_files_are_not(
    played: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    code, same = replayed(played, capsys)
    assert (code, same["visits"], same["same"], same["differ"], same["unknown"]) == (0, 1, 1, [], [])
    code, same = replayed(played, capsys, "--bundle", str(played))
    assert (code, same["same"], same["differ"]) == (0, 1, [])
    behavior = next((played / "behaviors").glob("*.yaml"))
    text = behavior.read_text("utf-8")
    assert "Hello" in text
    behavior.write_text(text.replace("Hello", "Ahoy"), "utf-8")
    code, other = replayed(played, capsys, "--bundle", str(played))
    assert (code, other["same"]) == (1, 0)
    (row,) = other["differ"]  # type: ignore[misc]  # a list
    assert (row["visit"], row["how"]) == (1, "says something else")
    assert "Hello" in row["was"]
    assert "Ahoy" in row["is"]
    assert replayed(played, capsys)[0] == 0, "the files that ran then are kept"


def test_a_run_is_shown_again(played: Path, capsys: pytest.CaptureFixture[str]) -> None:
    capsys.readouterr()
    assert main(["replay", "--project", str(played), "--robot", "recording", "--speed", "max"]) == 0
    assert "“Hello" in capsys.readouterr().out


def test_what_there_is_to_replay(played: Path, capsys: pytest.CaptureFixture[str]) -> None:
    capsys.readouterr()
    assert main(["replay", "--project", str(played), "--list"]) == 0
    (line,) = capsys.readouterr().out.splitlines()
    file = line.split()[-1]
    assert replayed(played, capsys, file)[1]["visits"] == 1
    assert replayed(played, capsys, file, "--until", "00:00")[0] == 0
    for words, says in (
        (["tomorrow"], "is neither a file nor a day"),
        ([date.today().isoformat()], "there is no journal of"),
        (["nothing.journal"], "no file nothing.journal"),
        (["--all"], "there is no journal in"),
        (["--until", "25:00"], "is not a time of day"),
    ):
        assert main(["replay", "--project", str(played), *words]) == 2
        assert says in capsys.readouterr().err
    Path(file).write_bytes(b"not a journal")
    assert main(["replay", "--project", str(played), file]) == 2
    assert "is not a journal" in capsys.readouterr().err


def test_a_diff_plays_the_visits_that_are_kept(played: Path, capsys: pytest.CaptureFixture[str]) -> None:
    journal = played / ".lumen" / "journal"
    for file in (journal / "rehearsed").glob("*.journal"):
        file.rename(journal / file.name)
    capsys.readouterr()
    assert main(["diff", str(played), str(played), "--visits"]) == 0
    assert "1 visit, " in capsys.readouterr().out
