"""Files of the journal: a file cut at any byte is a prefix; faults are reported, and old files are deleted."""

import os
import random
from pathlib import Path

import pytest

from lumen.errors import JournalError
from lumen.insight.replay.entries import JournalInput, RecordedEntry
from lumen.journal.journal_file import FramePacker, JournalHeader, header_of, line_of, read_content, read_journal
from lumen.journal.journal_folder import DAY, JournalFolder
from lumen.journal.redaction import redact
from lumen.language.events import Event
from lumen.language.people import PersonName

HEADER = JournalHeader(5, "run", "hash", 1.0)


def entries(count: int, seed: int) -> list[RecordedEntry]:
    chance = random.Random(seed)
    words = ["hello", "my name is Ada", "ä ö ü", "", "\U0001f916"]
    return [
        JournalInput(5 + i, "heard", Event("heard", {"result": chance.choice(words), "x": chance.random()}, i * 0.1))
        for i in range(count)
    ]


def packed(rows: list[RecordedEntry], per_frame: int) -> bytes:
    packer, lines = FramePacker(), [line_of(row) for row in rows]
    frames = [packer.pack(b"".join(lines[at : at + per_frame])) for at in range(0, len(lines), per_frame)]
    return HEADER.line() + b"".join(frames)


def is_prefix_at_every(step: int, seed: int) -> int:
    """Cut a file at every `step` bytes; return the number of cuts."""
    rows = entries(12, seed)
    data, begins, longest = packed(rows, 1 + seed % 4), len(HEADER.line()), 0
    for end in range(begins, len(data) + 1, step):
        found = read_content(data[:end], "x.journal")
        assert list(found.entries) == rows[: len(found.entries)]
        assert len(found.entries) >= longest
        longest = len(found.entries)
    assert read_content(data, "x.journal") == (HEADER, tuple(rows), True)
    return (len(data) - begins) // step


@pytest.mark.parametrize("seed", range(4))
def test_a_file_that_was_cut_is_read_up_to_the_cut(seed: int) -> None:
    is_prefix_at_every(7, seed)


@pytest.mark.soak
def test_two_hundred_files_are_cut_at_every_byte() -> None:
    cuts = sum(is_prefix_at_every(1, seed) for seed in range(200))
    assert cuts > 50_000


def test_a_damaged_byte_costs_what_follows_it() -> None:
    rows = entries(40, 1)
    data = bytearray(packed(rows, 4))
    data[len(data) // 2] ^= 0x10
    found = read_content(bytes(data), "x.journal")
    assert 0 < len(found.entries) < len(rows)
    assert list(found.entries) == rows[: len(found.entries)]
    assert not found.whole


@pytest.mark.parametrize(
    ("line", "says"),
    [
        (b'{"lumen-journal":2,"first":0,"run":"","bundle":"","began":0}\n', "version 2"),
        (b'{"lumen-journal":1,"first":0}\n', "is not a journal"),
        (b'{"lumen-jour', "its first line is incomplete"),
        (b"", "is not a journal"),
        (b"\xff\n", "is not a journal"),
    ],
)
def test_what_is_no_journal_of_ours_is_told(line: bytes, says: str, tmp_path: Path) -> None:
    file = tmp_path / "x.journal"
    file.write_bytes(line)
    for read in (read_journal, header_of):
        with pytest.raises(JournalError, match=says):
            read(file)


def test_positions_go_on_after_what_is_there(tmp_path: Path) -> None:
    folder = JournalFolder(tmp_path, 30.0, 100.0)
    assert folder.next_position() == 0
    (tmp_path / "000000000005-x.journal").write_bytes(packed(entries(9, 1), 2)[:-3])
    (tmp_path / "000000000099-x.journal").write_bytes(b"")
    assert folder.next_position() == 5 + 8


def test_what_is_old_and_what_is_too_much_is_deleted(tmp_path: Path) -> None:
    for number in range(6):
        file = tmp_path / f"{number:012d}-x.journal"
        file.write_bytes(bytes(400_000))
        os.utime(file, (1e9 + number, 1e9 + number))
    os.utime(tmp_path / "000000000000-x.journal", (1e9 - 3 * DAY,) * 2)
    JournalFolder(tmp_path, 2.0, 100.0).prune(1e9)
    assert [file.name[11] for file in JournalFolder(tmp_path, 2.0, 1.0).files()] == ["1", "2", "3", "4", "5"]
    JournalFolder(tmp_path, 2.0, 1.0).prune(1e9)
    assert [file.name[11] for file in JournalFolder(tmp_path, 2.0, 1.0).files()] == ["4", "5"]
    JournalFolder(tmp_path, 0.001, 1.0).prune(1e9 + 9 * DAY)
    assert [file.name[11] for file in JournalFolder(tmp_path, 2.0, 1.0).files()] == ["5"]


def test_what_a_cut_left_is_gone_when_somebody_is_forgotten(tmp_path: Path) -> None:
    """A cut entry is removed, since a name in it can't be recognised."""
    file = tmp_path / "x.journal"
    file.write_bytes(packed(entries(20, 1), 4)[:-3] + b"Budi")
    os.utime(file, (1e9, 1e9))
    assert redact(file, PersonName("Nobody Else")) == 0
    assert b"Budi" not in file.read_bytes()
    assert read_journal(file).whole
    assert len(read_journal(file).entries) == 16
    assert file.stat().st_mtime == 1e9, "it is not kept for longer"


def test_a_file_without_somebody_is_as_old_as_it_was(tmp_path: Path) -> None:
    file = tmp_path / "x.journal"
    file.write_bytes(packed(entries(20, 1), 4))
    os.utime(file, (1e9, 1e9))
    assert redact(file, PersonName("Ada"))
    assert file.stat().st_mtime == 1e9
