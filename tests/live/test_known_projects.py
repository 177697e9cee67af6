"""A project that was read before is not read again: it is the same project, and only for the very same files."""

import os
import shutil
from pathlib import Path
from typing import NamedTuple

import pytest

from lumen.language.projects import Project
from lumen.project.files import read_files
from lumen.run.reload import known_projects
from lumen.run.reload.idle_process import end_idle
from lumen.run.reload.validation_worker import ValidationWorker, load_apart
from lumen.upkeep import judge_process, own_folders
from tests.features.skills.changing import project_in
from tests.live.conftest import trimmed
from tests.tour.conftest import copied

pytestmark = pytest.mark.process

MAIN = "lumen.yaml"


class Known(NamedTuple):
    """A project that one process has judged, and the cache that keeps it."""

    folder: Path
    project: Project
    cache: Path


@pytest.fixture(scope="module")
def known(tmp_path_factory: pytest.TempPathFactory) -> Known:
    """A project that was judged once for all tests; do not change its files or its cache."""
    folder, home = trimmed(copied(tmp_path_factory.mktemp("project"))), tmp_path_factory.mktemp("home")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_CACHE_HOME", str(home))
        project, _ = load_apart(folder, read_files(folder))
    assert project
    return Known(folder, project, home / "lumen/projects")


@pytest.fixture(autouse=True)
def cache(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """The folder of the test's own cache, which is not there yet."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    return tmp_path / "cache/lumen/projects"


@pytest.fixture
def kept(known: Known, cache: Path) -> Path:
    """A copy of the judged project, which the test's cache keeps; both may be changed."""
    shutil.copytree(known.cache, cache)
    return Path(shutil.copytree(known.folder, cache.parents[2] / "project"))


def alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """From now on, let the start of a process fail, and also the use of one that runs."""

    def refused(*_: object, **__: object) -> object:
        raise AssertionError("a process is begun")

    end_idle()
    monkeypatch.setattr(judge_process.subprocess, "Popen", refused)


@pytest.mark.usefixtures("kept")
def test_the_second_start_needs_no_process(known: Known, monkeypatch: pytest.MonkeyPatch) -> None:
    alone(monkeypatch)
    again, _ = load_apart(known.folder, read_files(known.folder))
    assert again == known.project
    assert again
    assert again.documents["behaviors/tour.yaml"] == known.project.documents["behaviors/tour.yaml"]


def test_the_same_files_elsewhere_are_the_same_project_there(kept: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    alone(monkeypatch)
    found, _ = load_apart(kept, read_files(kept))
    assert found
    assert found.root == str(kept)


def test_the_same_files_elsewhere_have_their_skills_there(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    before, after = project_in(tmp_path / "before"), project_in(tmp_path / "after")
    load_apart(before, read_files(before))
    alone(monkeypatch)
    found, _ = load_apart(after, read_files(after))
    assert found
    assert found.verbs["spray"].root == found.root == str(after)


@pytest.mark.parametrize("what", ["a file", "a file of a model that is not read", "the engine"])
def test_anything_else_is_read(what: str, kept: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    alone(monkeypatch)
    match what:
        case "a file":
            (kept / MAIN).write_bytes((kept / MAIN).read_bytes() + b"# more\n")
        case "the engine":
            monkeypatch.setattr(known_projects, "engine", lambda: "another")
        case _:
            (kept / "models/foot.stl").write_bytes(b"")
    with pytest.raises(AssertionError, match="a process is begun"):
        load_apart(kept, read_files(kept))


@pytest.mark.parametrize("trouble", ["half of it", "nonsense", "others may write there"])
def test_what_is_kept_badly_is_read_again(
    trouble: str, kept: Path, cache: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert [*cache.iterdir()]
    for file in cache.iterdir():
        if trouble in ("half of it", "nonsense"):
            file.write_bytes(file.read_bytes()[:1000] if trouble == "half of it" else b"nonsense")
    if trouble == "others may write there":
        cache.chmod(0o777)
    alone(monkeypatch)
    with pytest.raises(AssertionError, match="a process is begun"):
        load_apart(kept, read_files(kept))


def test_what_can_not_be_kept_is_read_again(copy: Path, cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    cache.parent.parent.mkdir()
    cache.parent.write_bytes(b"")
    files = read_files(copy)
    assert load_apart(copy, files)[0]
    alone(monkeypatch)
    with pytest.raises(AssertionError, match="a process is begun"):
        load_apart(copy, files)


def test_files_with_errors_are_not_kept(copy: Path, cache: Path) -> None:
    assert load_apart(copy, {**read_files(copy), MAIN: b"name: ["})[0] is None
    assert not cache.exists()


def test_the_oldest_go(cache: Path) -> None:
    kept = own_folders.CacheFolder("projects", 2)
    for number in range(4):
        kept.write(str(number), b"")
        os.utime(cache / str(number), (number, number))
    assert sorted(file.name for file in cache.iterdir()) == ["2", "3"]


def test_what_judges_reads_what_runs_before_anybody_saves(copy: Path) -> None:
    files = read_files(copy)
    load_apart(copy, files)
    end_idle()
    worker = ValidationWorker(copy)
    worker.warm(files)
    assert worker.packed
    worker.close()
