"""An unchanged file is not read again; every kind of change to a file is noticed."""

import os
import time
from pathlib import Path

import pytest

from lumen.project import kept_contents
from lumen.project.files import read_files
from lumen.project.kept_contents import SETTLED_NS, KeptContents

OLD = time.time_ns() - 10 * SETTLED_NS


@pytest.fixture
def counted(monkeypatch: pytest.MonkeyPatch) -> list[Path]:
    """The files that were opened."""
    opened: list[Path] = []
    read = kept_contents.read_regular

    def reading(path: Path, most: int) -> bytes:
        opened.append(path)
        return read(path, most)

    monkeypatch.setattr(kept_contents, "read_regular", reading)
    return opened


@pytest.fixture
def root(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A project whose files count as settled."""
    (tmp_path / "behaviors").mkdir()
    (tmp_path / "lumen.yaml").write_text("name: a", "utf-8")
    (tmp_path / "behaviors/tour.yaml").write_text("root: {}", "utf-8")
    monkeypatch.setattr(kept_contents, "SETTLED_NS", -SETTLED_NS)
    return tmp_path


def test_what_nobody_touched_is_not_read_again(root: Path, counted: list[Path]) -> None:
    kept = KeptContents()
    first = read_files(root, kept=kept)
    assert len(counted) == 2
    assert read_files(root, kept=kept) == first
    assert len(counted) == 2


def test_what_was_just_written_is_read_again(root: Path, counted: list[Path], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(kept_contents, "SETTLED_NS", SETTLED_NS)
    kept = KeptContents()
    read_files(root, kept=kept)
    read_files(root, kept=kept)
    assert len(counted) == 4


def test_the_same_size_and_an_old_date_do_not_hide_a_change(root: Path) -> None:
    kept, file = KeptContents(), root / "lumen.yaml"
    os.utime(file, ns=(OLD, OLD))
    read_files(root, kept=kept)
    file.write_text("name: b", "utf-8")
    os.utime(file, ns=(OLD, OLD))
    assert read_files(root, kept=kept)["lumen.yaml"] == b"name: b"


def test_a_file_that_takes_its_place_is_read(root: Path) -> None:
    kept, file, other = KeptContents(), root / "lumen.yaml", root / "other"
    read_files(root, kept=kept)
    other.write_text("name: c", "utf-8")
    os.replace(other, file)
    assert read_files(root, kept=kept)["lumen.yaml"] == b"name: c"
    file.unlink()
    assert "lumen.yaml" not in read_files(root, kept=kept)
