"""Without a project, `lumen run` plays a copy of the shipped exhibition: nothing is written into the installation."""

import sys
import threading
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import pytest

from lumen.cli.main import main
from lumen.errors import LumenError, UsageError
from lumen.project import running_project as module
from lumen.project.home import STATE_FOLDER, home_of
from lumen.project.packaged import PACKAGE, shipped_root
from lumen.project.running_project import copy_of_shipped, project_to_run, running_project
from tests import ROOT
from tests.copying import copied_project
from tests.guarded import run_guarded
from tests.tables import for_each
from tests.waiting import HANG


@pytest.fixture
def state(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty state folder of the user, who is in an empty folder."""
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    return tmp_path / "state"


@pytest.fixture
def small(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A read-only installation of an exhibition of two files."""
    root = tmp_path / "installed"
    (root / "behaviors").mkdir(parents=True)
    for name in ("lumen.yaml", "behaviors/tour.yaml"):
        (root / name).write_text("initial: a\n", "utf-8")
        (root / name).chmod(0o444)
    for folder in (root / "behaviors", root):
        folder.chmod(0o555)
    monkeypatch.setattr(module, "shipped_root", lambda: root)
    module._digest.cache_clear()
    yield root
    module._digest.cache_clear()
    for folder in (root, root / "behaviors"):
        folder.chmod(0o755)


INSTALLED = """
import sys
from pathlib import Path
from lumen.project import packaged
package, packaged.PACKAGE = packaged.PACKAGE, Path(sys.argv[1], "engine", "lumen")
assert str(packaged.shipped_root()) == sys.argv[1]  # and so from now on
packaged.PACKAGE = package
from lumen.cli.main import main
sys.exit(main(sys.argv[2:]))
"""
"""`lumen` as if it were installed in a folder."""


@pytest.mark.process
def test_a_run_in_an_empty_folder_writes_into_the_state_folder_only(
    state: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    installed = copied_project(ROOT, tmp_path / "installed")  # other tests write into the repository
    copied_project(ROOT / "schemas", installed / "schemas")
    before = {*installed.rglob("*")}
    words = ["run", "--robot", "recording", "--speed", "max", "--for", "1s"]
    command = [sys.executable, "-c", INSTALLED, installed, *words]
    done = run_guarded(command, capture_output=True, text=True, timeout=HANG)
    assert done.returncode == 0, done.stderr
    assert {*installed.rglob("*")} == before
    assert list(Path.cwd().iterdir()) == []
    (root,) = (state / "lumen").iterdir()
    journal = root / STATE_FOLDER / "journal"
    assert list(journal.rglob("*.journal"))
    (line,) = [line for line in done.stderr.splitlines() if "no lumen.yaml" in line]
    assert f"a copy of its own exhibition, {root}." in line
    assert str(journal) in line
    assert main(["replay"]) == 0  # the other commands find it


@pytest.mark.process
@for_each(
    "words",
    [
        "export mermaid", "hear hello --state idle", "graph", "play none", "plot none",
        "replay --list", "story", "memory visitors",
        "status", "why", "stop", "goto idle --yes", "topic list", "reload", "model off",
    ],
)  # fmt: skip
def test_every_command_without_a_project_is_about_the_copy_that_run_plays(
    words: str, state: Path, small: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    copy = project_to_run()
    with suppress(SystemExit, LumenError):
        main(words.split())
    said = capsys.readouterr().err
    assert said.count(f"There is no lumen.yaml here or above: this is the copy that `lumen run` plays, {copy}.\n") == 1


def test_a_project_that_is_here_or_named_is_not_copied(state: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert running_project() == shipped_root()  # there is no copy yet
    assert project_to_run(shipped_root()) == shipped_root()
    monkeypatch.chdir(shipped_root() / "behaviors")
    assert project_to_run() == running_project() == Path.cwd().parent
    assert not state.exists()


def test_a_copy_of_a_read_only_installation_can_be_written(state: Path, small: Path) -> None:
    copy = project_to_run()
    assert copy == copy_of_shipped() == running_project()
    assert {file.relative_to(copy).as_posix() for file in copy.rglob("*") if file.is_file()} == {
        "lumen.yaml",
        "behaviors/tour.yaml",
    }
    assert all(path.stat().st_mode & 0o200 for path in (copy, *copy.rglob("*")))


def test_a_copy_is_kept_with_what_its_user_changed(state: Path, small: Path) -> None:
    (project_to_run() / "lumen.yaml").write_text("initial: b\n", "utf-8")
    assert (project_to_run() / "lumen.yaml").read_text("utf-8") == "initial: b\n"


def test_runs_that_begin_at_once_share_one_copy(state: Path, small: Path) -> None:
    found: list[Path] = []
    begin = threading.Barrier(4)

    def run() -> None:
        begin.wait()
        found.append(project_to_run())

    threads = [threading.Thread(target=run) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert (len(found), set(found), list((state / "lumen").iterdir())) == (4, {copy_of_shipped()}, [copy_of_shipped()])


def test_a_state_folder_that_cannot_be_written_is_a_usage_error(state: Path, small: Path) -> None:
    state.write_text("a file", "utf-8")
    with pytest.raises(UsageError, match=r"set XDG_STATE_HOME to a writable folder.*`lumen new DIR`"):
        project_to_run()


def test_the_home_of_an_installed_exhibition_is_in_the_state_folder(state: Path) -> None:
    assert home_of(PACKAGE / "exhibition").parent == state / "lumen"
    assert home_of(PACKAGE / "exhibition/examples/museum").parent == state / "lumen"
