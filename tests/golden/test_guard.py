"""`make check` refuses a golden that changes together with much of the engine, or without a record of the decision."""

import json
from pathlib import Path

import golden_guard
import pytest

from tests.guarded import run_guarded
from tests.provided import program

GOLDEN = "tests/golden/recorded/runs/tour.txt"
RECORD = "docs/decisions/200-why.md"
ENGINE = "engine/lumen/bus.py"
FLOORS = golden_guard.FLOORS
LONG = "x = 1\n" * 60


@pytest.fixture
def repository(tmp_path: Path) -> Path:
    """A repository with a golden, on a branch that left `main`."""
    git(tmp_path, "init", "-q", "-b", "main")
    commit(tmp_path, {GOLDEN: "a\n", ENGINE: "y = 1\n", FLOORS: floors(bus=10)})
    commit(tmp_path, {"README.md": "main\n"})
    git(tmp_path, "checkout", "-q", "-b", "branch")
    return tmp_path


def git(folder: Path, *words: str) -> None:
    who = ("-c", "user.name=Ada", "-c", "user.email=ada@example.org")
    run_guarded([program("git"), *who, *words], cwd=folder, check=True)


def write(folder: Path, files: dict[str, str]) -> None:
    for name, text in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, "utf-8")


def commit(folder: Path, files: dict[str, str]) -> None:
    write(folder, files)
    git(folder, "add", "-A")
    git(folder, "commit", "-q", "-m", "Change")


def floors(**counts: int) -> str:
    return json.dumps({folder: {"functions": count} for folder, count in counts.items()}, indent=1)


ALLOWED: dict[str, dict[str, str]] = {
    "a golden with its record": {GOLDEN: "b\n", RECORD: "why\n"},
    "with a little of the engine": {GOLDEN: "b\n", RECORD: "why\n", ENGINE: "y = 2\n"},
    "a first recording": {"tests/golden/recorded/new/a.txt": "a\n"},
    "much of the engine": {ENGINE: LONG},
    "a floor that rises": {FLOORS: floors(bus=11, cli=3), ENGINE: LONG},
}
REFUSED: dict[str, tuple[dict[str, str], str]] = {
    "a golden alone": ({GOLDEN: "b\n"}, f"{GOLDEN} changed without a record"),
    "with much of the engine": ({GOLDEN: "b\n", RECORD: "why\n", ENGINE: LONG}, "61 changed lines of engine/"),
    "a first recording with much": ({"tests/golden/recorded/new/a.txt": "a\n", ENGINE: LONG}, "61 changed lines"),
    "a floor that falls": ({FLOORS: floors(bus=9, cli=3)}, f"{FLOORS} changed without a record"),
    "a floor that goes": ({FLOORS: floors(cli=3)}, f"{FLOORS} changed without a record"),
}


@pytest.mark.parametrize("committed", [True, False], ids=["committed", "saved"])
@pytest.mark.parametrize("files", ALLOWED.values(), ids=ALLOWED)
def test_what_is_allowed(files: dict[str, str], committed: bool, repository: Path) -> None:
    (commit if committed else write)(repository, files)
    assert golden_guard.main(repository) == 0


@pytest.mark.parametrize("committed", [True, False], ids=["committed", "saved"])
@pytest.mark.parametrize(("files", "words"), REFUSED.values(), ids=REFUSED)
def test_what_is_refused(
    files: dict[str, str], words: str, committed: bool, repository: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (commit if committed else write)(repository, files)
    assert golden_guard.main(repository) == 1
    assert words in capsys.readouterr().err


def test_each_commit_is_looked_at_alone(repository: Path) -> None:
    commit(repository, {ENGINE: LONG})
    commit(repository, {GOLDEN: "b\n", RECORD: "why\n"})
    assert golden_guard.main(repository) == 0
    commit(repository, {GOLDEN: "c\n"})
    commit(repository, {RECORD: "too late\n"})
    assert golden_guard.main(repository) == 1


def test_a_golden_that_is_deleted_or_moved_needs_a_record(repository: Path) -> None:
    git(repository, "mv", GOLDEN, "tests/golden/recorded/runs/other.txt")
    assert golden_guard.main(repository) == 1
    write(repository, {RECORD: "why\n"})
    assert golden_guard.main(repository) == 0


def test_files_of_the_engine_that_only_move_count_for_nothing(repository: Path) -> None:
    commit(repository, {ENGINE: LONG})
    git(repository, "mv", ENGINE, "engine/lumen/messages.py")
    write(repository, {GOLDEN: "b\n", RECORD: "why\n"})
    git(repository, "add", "-A")
    assert golden_guard.main(repository) == 0


def test_on_main_the_last_commit_is_looked_at(repository: Path) -> None:
    git(repository, "checkout", "-q", "main")
    commit(repository, {GOLDEN: "b\n"})
    assert golden_guard.main(repository) == 1
    commit(repository, {"README.md": "more\n"})
    assert golden_guard.main(repository) == 0


@pytest.mark.process
def test_without_a_repository_that_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert golden_guard.main(tmp_path) == 0
    assert "no git repository" in capsys.readouterr().err
