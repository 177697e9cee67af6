"""Files that Lumen writes on disks that are full, closed or odd: a file is written whole or stays as it was."""

import errno
import os
import resource
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

from lumen.cli.main import main
from lumen.project.files import read_files
from lumen.upkeep import replacing
from lumen.upkeep.replacing import replace_file
from tests.reports.small_project import MINIMAL, MISSPELT, STATES, TOUR, placed, project
from tests.tables import for_each

CHART = '<scxml xmlns="http://www.w3.org/2005/07/scxml" version="1.0"><state id="a"/></scxml>'
WRITERS = {
    "import": ["import", "chart.scxml", "-o", "OUT.yaml"],
    "export": ["export", "scxml", "-o", "OUT.scxml"],
    "graph": ["graph", "-o", "OUT.dot"],
    "plot": ["plot", "motions/wave.yaml", "-o", "OUT.svg"],
    "schema": ["schema", "behavior", "-o", "OUT.json"],
    "test": ["test", "--format", "junit", "-o", "OUT.xml"],
}


@pytest.mark.parametrize("verb", [*sorted(WRITERS.keys() - {"plot"}), pytest.param("plot", marks=pytest.mark.process)])
def test_a_full_disk_leaves_the_file_that_was_there(
    verb: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    placed(tmp_path, read_files(MINIMAL))
    (tmp_path / "chart.scxml").write_text(CHART)
    output = tmp_path / WRITERS[verb][-1]
    monkeypatch.chdir(tmp_path)
    assert main(WRITERS[verb]) == 0  # Matplotlib looks for fonts when it is first used
    output.write_text("kept")
    before = sorted(tmp_path.rglob("*"))

    def full(handle: int) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    with monkeypatch.context() as disk:
        disk.setattr(os, "fsync", full)
        assert main(WRITERS[verb]) == 2
    assert f"can't write {output.name}: no space left on device" in capsys.readouterr().err
    assert output.read_text() == "kept"
    assert sorted(path for path in tmp_path.rglob("*") if ".lumen" not in path.parts) == before
    assert main(WRITERS[verb]) == 0
    assert output.read_text() != "kept"


def test_a_disk_that_refuses_half_of_a_file_leaves_the_whole_one(tmp_path: Path) -> None:
    file, kept = tmp_path / "a", resource.getrlimit(resource.RLIMIT_FSIZE)
    file.write_bytes(b"kept")
    resource.setrlimit(resource.RLIMIT_FSIZE, (50_000, kept[1]))
    try:
        with pytest.raises(OSError, match="large"):
            replace_file(file, b"x" * 100_000)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, kept)
    assert file.read_bytes() == b"kept"
    assert [path.name for path in tmp_path.iterdir()] == ["a"]


def test_a_repaired_file_keeps_its_owner_its_rights_and_its_link(tmp_path: Path) -> None:
    placed(tmp_path, project("tour.yaml", MISSPELT))
    file, real = tmp_path / TOUR, tmp_path / "behaviors" / "real.txt"
    file.rename(real)
    file.symlink_to("real.txt")
    real.chmod(0o640)
    if os.geteuid() == 0:
        os.chown(real, 65534, 65534)
    before = real.stat()
    assert main(["lint", "--fix", str(tmp_path)]) == 0
    after = real.stat()
    assert real.read_bytes() == STATES.encode()
    assert file.is_symlink()
    assert (after.st_uid, after.st_gid, after.st_mode) == (before.st_uid, before.st_gid, before.st_mode)
    assert after.st_mtime_ns >= before.st_mtime_ns


def test_a_file_of_another_owner_is_written_to(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "a"
    file.write_bytes(b"a longer text")
    number, stat = file.stat().st_ino, os.stat

    def of_another(path: Path, **options: bool) -> os.stat_result:
        found = stat(path, **options)
        return os.stat_result((*found[:4], found.st_uid + (path == file), *found[5:]))

    def refused(*given: object) -> None:
        raise PermissionError(errno.EPERM, os.strerror(errno.EPERM))

    with monkeypatch.context() as patch:
        patch.setattr(os, "stat", of_another)
        patch.setattr(os, "chown", refused)
        replace_file(file, b"new")
    assert (file.read_bytes(), file.stat().st_ino) == (b"new", number)
    assert [path.name for path in tmp_path.iterdir()] == ["a"]


def test_a_file_that_a_container_mounts_alone_is_written_to(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "a"
    file.write_bytes(b"a longer text")

    def busy(*given: object) -> None:
        raise OSError(errno.EBUSY, os.strerror(errno.EBUSY))

    monkeypatch.setattr(os, "replace", busy)
    replace_file(file, b"new")
    assert file.read_bytes() == b"new"
    assert [path.name for path in tmp_path.iterdir()] == ["a"]


@for_each("number", [errno.EACCES, errno.EROFS])
def test_a_file_in_a_folder_without_room_for_another_is_written_to(number: int) -> None:
    """For example a writable file in a folder that only its owner may write."""
    with TemporaryDirectory() as folder, pytest.MonkeyPatch.context() as patch:
        file = Path(folder, "a")
        file.write_bytes(b"a longer text")

        def refused(*given: object) -> None:
            raise OSError(number, os.strerror(number))

        patch.setattr(replacing, "_write", refused)
        replace_file(file, b"new")
        assert file.read_bytes() == b"new"
        with pytest.raises(OSError, match=os.strerror(number)):
            replace_file(Path(folder, "b"), b"new")


def test_a_file_that_may_not_be_written_is_not_replaced(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "a"
    file.write_bytes(b"kept")
    monkeypatch.setattr(os, "access", lambda path, mode: False)
    with pytest.raises(PermissionError):
        replace_file(file, b"new")
    assert file.read_bytes() == b"kept"


def test_a_folder_called_dev_holds_files_like_any_other(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "robots" / "dev" / "a"
    file.parent.mkdir(parents=True)
    file.write_bytes(b"old")
    before = file.stat().st_ino
    monkeypatch.chdir(tmp_path)
    replace_file(Path("robots/dev/a"), b"new")
    assert file.read_bytes() == b"new"
    assert file.stat().st_ino != before


def test_a_target_that_is_no_regular_file_is_written_to(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    replace_file(Path("/dev/stdout"), b"printed")
    replace_file(Path(os.devnull), b"gone")
    assert capfd.readouterr().out == "printed"
    assert not Path(os.devnull).is_file()
    with pytest.raises(OSError, match="irectory"):
        replace_file(tmp_path, b"no")
    loop = tmp_path / "loop"
    loop.symlink_to("loop")
    with pytest.raises(OSError, match="symbolic links"):
        replace_file(loop, b"no")


@pytest.mark.network
def test_a_recording_under_another_name_prints_that_name(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    placed(tmp_path, read_files(MINIMAL))
    file = tmp_path / "a.mcap"
    command = ["run", str(tmp_path), "--robot", "recording", "--speed", "max", "--story", "visitor"]
    assert main([*command, "--record", str(file)]) == 0
    assert "is there already" not in capsys.readouterr().out
    first = file.read_bytes()
    assert main([*command, "--record", str(file)]) == 0
    told = " ".join(capsys.readouterr().out.split())
    assert f"{file} already exists: this recording is saved as {tmp_path / 'a-2.mcap'}" in told
    assert file.read_bytes() == first
