"""A run's home may hold files that Lumen did not write: the sender of a project may include a `.lumen/` folder."""

import os
import sys
from contextlib import suppress
from pathlib import Path

import pytest

from lumen.errors import UsageError
from lumen.project.crash_counter import CrashCounter
from lumen.project.home import Home, home_of
from lumen.run import snapshot_store
from lumen.run.snapshot_store import SnapshotStore


@pytest.mark.parametrize("name", ["door.json", "door.json.new", "lock"])
def test_a_link_in_a_home_leads_nowhere(tmp_path: Path, name: str) -> None:
    precious, home = tmp_path / "precious", Home(tmp_path / ".lumen")
    precious.write_text("{}")
    home.folder.mkdir()
    (home.folder / name).symlink_to(precious)
    assert home.read_json("door.json") is None
    home.write("door.json", b"[1]")
    with suppress(UsageError):
        home.hold()
    home.release()
    assert precious.read_text() == "{}"


def test_asking_for_a_home_that_is_held_leaves_no_file_open(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    opened, closed = list[int](), list[int]()
    holder, opens, closes = Home(tmp_path / ".lumen"), os.open, os.close
    assert holder.hold()
    monkeypatch.setattr(os, "open", lambda *words: opened.append(opens(*words)) or opened[-1])
    monkeypatch.setattr(os, "close", lambda file: (closed.append(file), closes(file))[1])
    assert not Home(holder.folder).hold()
    assert Home(holder.folder).held()
    monkeypatch.undo()
    assert opened
    assert closed == opened
    holder.release()


@pytest.mark.skipif(sys.platform == "win32", reason="files have no limit of size there")
def test_a_disk_that_takes_a_part_of_a_file_leaves_the_one_before(tmp_path: Path) -> None:
    import resource

    home = Home(tmp_path)
    assert home.write_json("trials.json", {"a": 1}) == ""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100, hard))
    try:
        why = home.write_json("trials.json", {"a": "x" * 200})
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert why == "file too large"
    assert home.read_json("trials.json") == {"a": 1}


def test_a_home_that_is_a_link_is_not_used(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    (tmp_path / "show").mkdir()
    assert home_of(tmp_path / "show") == tmp_path / "show" / ".lumen"
    (tmp_path / "show" / ".lumen").symlink_to(tmp_path)
    assert home_of(tmp_path / "show").is_relative_to(tmp_path / "state")


@pytest.mark.parametrize("link", ["journal.jsonl", "memory.db-wal", "physics/case.json", "faces"])
def test_a_home_that_holds_a_link_is_not_used(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, link: str) -> None:
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    inside = tmp_path / "show" / ".lumen"
    (inside / link).parent.mkdir(parents=True)
    (inside / "snapshot.json").write_text("{}")
    assert home_of(tmp_path / "show") == inside
    (inside / link).symlink_to(tmp_path)
    assert home_of(tmp_path / "show").is_relative_to(tmp_path / "state")


@pytest.mark.parametrize("content", [b"[" * 100_000, b"9" * 5_000, b"\xff", b"", b'{"bundles": {"a": 1e999}}'])
def test_what_nobody_of_us_wrote_into_a_home_is_as_good_as_nothing(tmp_path: Path, content: bytes) -> None:
    home = Home(tmp_path)
    for name in ("snapshot.json", "good.json", "trials.json"):
        home.write(name, content)
    assert SnapshotStore(home).kept() is None
    assert SnapshotStore(home).good() == ""
    assert CrashCounter(home).count("a") == 0


def test_a_bundle_that_unpacks_to_gigabytes_is_not_unpacked(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    store, files = SnapshotStore(Home(tmp_path)), {"lumen.yaml": b"#" * 100_000}
    hash = store.store(files)
    assert store.files(hash) == files
    monkeypatch.setattr(snapshot_store, "MAX_PROJECT_BYTES", 10_000)
    assert store.files(hash) is None


def test_a_bundle_that_was_torn_is_written_again(tmp_path: Path) -> None:
    store, files = SnapshotStore(Home(tmp_path)), {"lumen.yaml": b"name: Small\n"}
    hash = store.store(files)
    (tmp_path / f"bundle-{hash[:16]}.zip").write_bytes(b"PK")
    assert store.store(files) == hash
    assert store.files(hash) == files


def test_a_bundle_with_wrong_bits_is_not_used(tmp_path: Path) -> None:
    store, path = SnapshotStore(Home(tmp_path)), "lumen.yaml"
    hash = store.store({path: b"name: Small\n"})
    file, content = tmp_path / f"bundle-{hash[:16]}.zip", 30 + len(path)
    data = file.read_bytes()
    file.write_bytes(data[:content] + b"\xff" + data[content + 1 :])
    assert store.files(hash) is None
