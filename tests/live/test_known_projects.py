"""A project that was read before is not read again: it is the same project, and only for the very same files."""

import os
import shutil
from pathlib import Path

import pytest

from lumen.app.reload import known_projects, validation_worker
from lumen.app.reload.idle_process import end_idle
from lumen.app.reload.validation_worker import ValidationWorker, load_apart
from lumen.loading.files import read_files
from lumen.upkeep import cache_folder

MAIN = "lumen.yaml"


@pytest.fixture(autouse=True)
def cache(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    return tmp_path / "cache/lumen/projects"


def alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """From now on no process is begun or taken over."""

    def refused(*_: object, **__: object) -> object:
        raise AssertionError("a process is begun")

    end_idle()
    monkeypatch.setattr(validation_worker.subprocess, "Popen", refused)


def test_the_second_start_needs_no_process(copy: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    files = read_files(copy)
    first, _ = load_apart(copy, files)
    alone(monkeypatch)
    again, _ = load_apart(copy, files)
    assert again == first
    assert again
    assert again.documents["behaviors/tour.yaml"] == first.documents["behaviors/tour.yaml"]  # type: ignore[union-attr]


def test_the_same_files_elsewhere_are_the_same_project_there(
    copy: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    load_apart(copy, read_files(copy))
    alone(monkeypatch)
    there = Path(shutil.copytree(copy, tmp_path / "there"))
    found, _ = load_apart(there, read_files(there))
    assert found
    assert found.root == str(there)


@pytest.mark.parametrize("what", ["a file", "a file of a model that is not read", "the engine"])
def test_anything_else_is_read(what: str, copy: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (copy / "models").mkdir(exist_ok=True)
    load_apart(copy, read_files(copy))
    alone(monkeypatch)
    match what:
        case "a file":
            (copy / MAIN).write_bytes((copy / MAIN).read_bytes() + b"# more\n")
        case "the engine":
            monkeypatch.setattr(known_projects, "engine", lambda: "another")
        case _:
            (copy / "models/foot.stl").write_bytes(b"")
    with pytest.raises(AssertionError, match="a process is begun"):
        load_apart(copy, read_files(copy))


@pytest.mark.parametrize("trouble", ["half of it", "nonsense", "others may write there", "nothing can be kept"])
def test_what_is_kept_badly_is_read_again(
    trouble: str, copy: Path, cache: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    if trouble == "nothing can be kept":
        cache.parent.parent.mkdir()
        cache.parent.write_bytes(b"")
    files = read_files(copy)
    assert load_apart(copy, files)[0]
    for file in cache.iterdir() if cache.is_dir() else ():
        if trouble in ("half of it", "nonsense"):
            file.write_bytes(file.read_bytes()[:1000] if trouble == "half of it" else b"nonsense")
    if trouble == "others may write there":
        cache.chmod(0o777)
    alone(monkeypatch)
    with pytest.raises(AssertionError, match="a process is begun"):
        load_apart(copy, files)


def test_files_with_errors_are_not_kept(copy: Path, cache: Path) -> None:
    assert load_apart(copy, {**read_files(copy), MAIN: b"name: ["})[0] is None
    assert not cache.exists()


def test_the_oldest_go(cache: Path) -> None:
    kept = cache_folder.CacheFolder("projects", 2)
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
