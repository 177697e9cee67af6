"""The writer of the journal: no step waits for it, a disk that refuses is told once, and what is lost is counted."""

import errno
import threading
from contextlib import suppress
from pathlib import Path
from typing import Any, BinaryIO

import pytest

from lumen.errors import JournalError
from lumen.insight.replay.entries import JournalJump
from lumen.journal import journal_file, journal_writer
from lumen.journal.journal_file import JournalHeader, line_of, read_journal
from lumen.journal.journal_folder import JournalFolder
from lumen.journal.journal_writer import JournalWriter
from lumen.language.events import Event
from lumen.language.people import PersonName
from lumen.statechart import Machine, Step, initial, step
from tests.journal.making import Recorded, bundle
from tests.waiting import HANG, until

MACHINE = Machine.from_dict(
    {
        "context": {"who": ""},
        "states": {
            "idle": {"entry": {"assign": {"who": "''"}}, "on": {"come": "busy"}},
            "busy": {
                "on": {"heard": {"actions": [{"assign": {"who": "event.data.name"}}, {"say": "Hi"}]}, "go": "idle"}
            },
        },
    }
)
PROJECT = bundle(MACHINE)


class Disk(JournalFolder):
    """A disk that does not answer while it is `held`, and refuses what is written while it is `full`."""

    def __init__(self, folder: Path) -> None:
        super().__init__(folder, 30.0, 100.0)
        self.free, self.full = threading.Event(), False
        self.free.set()

    def open(self, header: JournalHeader) -> BinaryIO:
        return Slow(super().open(header), self)  # type: ignore[return-value]  # what of a file is used


class Slow:
    def __init__(self, file: BinaryIO, disk: Disk) -> None:
        self.file, self.disk = file, disk

    def write(self, data: bytes) -> int:
        assert self.disk.free.wait(HANG)
        if self.disk.full:
            raise OSError(errno.ENOSPC, "No space left on device")
        return self.file.write(data[:100])  # as a system may

    def __getattr__(self, name: str) -> Any:
        return getattr(self.file, name)


def steps(count: int) -> list[Step]:
    found = [initial(MACHINE)]
    for number in range(count):
        found.append(step(MACHINE, found[-1].snapshot, Event("come" if number % 2 else "go", None, number * 0.1)))
    return found[1:]


def tell(writer: JournalWriter, told: list[Step]) -> None:
    for each in told:
        writer.stepped(each, "heard")


@pytest.fixture
def disk(tmp_path: Path) -> Disk:
    return Disk(tmp_path)


def begun(disk: Disk) -> JournalWriter:
    writer = JournalWriter(disk)
    writer.start()
    writer.jumped("start", PROJECT, initial(MACHINE).snapshot)
    return writer


def read(disk: Disk) -> list[Any]:
    return [entry for file in disk.files() for entry in read_journal(file).entries]


def test_a_slow_disk_keeps_nobody_waiting_and_what_does_not_fit_is_a_gap(
    disk: Disk, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(journal_writer, "MAX_WAITING", 50)
    disk.free.clear()
    writer, made = begun(disk), steps(200)
    tell(writer, made[:150])  # returns, though nothing can be written
    disk.free.set()
    assert writer.flush(HANG)
    tell(writer, made[150:])
    writer.close(HANG)
    (gap,) = [entry for entry in read(disk) if isinstance(entry, JournalJump) and entry.kind == "gap"]
    kept = len([entry for entry in read(disk) if not isinstance(entry, JournalJump)])
    assert gap.said["lost"] + kept == len(made)
    assert not writer.trouble
    again = Recorded(disk.folder, bundles={PROJECT.hash: PROJECT}).again()
    assert not [row for row in again if row.differs or row.unknown]


def test_a_rehearsed_run_waits_for_a_slow_disk(disk: Disk, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(journal_writer, "MAX_WAITING", 50)
    writer, made = JournalWriter(disk, rehearsed=True), steps(200)
    flush = writer.flush
    monkeypatch.setattr(writer, "flush", lambda: disk.free.set() or flush(HANG))
    disk.free.clear()
    writer.start()
    writer.jumped("start", PROJECT, initial(MACHINE).snapshot)
    tell(writer, made)
    disk.free.set()
    writer.close(HANG)
    jumps = {entry.kind for entry in read(disk) if isinstance(entry, JournalJump)}
    assert "gap" not in jumps
    assert len([entry for entry in read(disk) if not isinstance(entry, JournalJump)]) == len(made)


def test_a_full_disk_is_told_once_and_costs_entries(
    disk: Disk, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(journal_writer, "RETRY_PERIOD", 0.0)
    writer, made = begun(disk), steps(30)
    tell(writer, made[:10])
    assert writer.flush(HANG)
    disk.full = True
    for at in (10, 15):
        tell(writer, made[at : at + 5])
        assert writer.flush(HANG)
    disk.full = False
    tell(writer, made[20:])
    writer.close(HANG)
    assert writer.trouble == "the journal can't be written: no space left on device"
    assert [record.levelname for record in caplog.records] == ["WARNING"]
    assert writer.lost
    kinds = [entry.kind for entry in read(disk) if isinstance(entry, JournalJump)]
    assert "gap" in kinds
    again = Recorded(disk.folder, bundles={PROJECT.hash: PROJECT}).again()
    assert not [row for row in again if row.differs or row.unknown]
    assert again[-1].after == made[-1].snapshot


def test_a_folder_that_can_not_be_made_costs_the_journal_and_nothing_else(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    writer = begun(Disk(tmp_path / "file" / "journal"))
    tell(writer, steps(5))
    assert writer.flush(HANG)
    writer.close(HANG)
    assert writer.trouble.startswith("the journal can't be written: ")
    assert writer.lost >= 5


def test_a_step_that_asks_for_something_is_on_the_disk_soon_and_in_order(disk: Disk) -> None:
    writer = begun(disk)
    busy = step(MACHINE, initial(MACHINE).snapshot, Event("come"))
    said = step(MACHINE, busy.snapshot, Event("heard", {"name": "Ada"}, 1.0))
    tell(writer, [busy, said])

    def there() -> bool:
        with suppress(JournalError):  # raised while the header is written
            return len(read(disk)) >= 3
        return False

    until(there)  # without flush or close
    assert [entry.position for entry in read(disk)] == list(range(len(read(disk))))
    writer.close(HANG)


def test_another_bundle_begins_another_file(disk: Disk) -> None:
    writer = begun(disk)
    other = bundle(Machine.from_dict({"states": {"idle": {}}}))
    writer.jumped("reload", other, initial(other.machine).snapshot)
    writer.close(HANG)
    assert [read_journal(file).header.bundle for file in disk.files()] == [PROJECT.hash, other.hash]


def test_somebody_who_is_forgotten_is_in_no_file_and_nothing_else_is_lost(disk: Disk) -> None:
    writer = begun(disk)
    told = [initial(MACHINE)]
    events = [("come", None), ("heard", {"name": "Budi"}), ("go", None), ("come", None), ("heard", {"name": "Ada"})]
    for number, (name, data) in enumerate(events):
        told.append(step(MACHINE, told[-1].snapshot, Event(name, data, number + 1.0)))
    tell(writer, told[1:])
    writer.forget(PersonName("budi"))
    writer.close(HANG)
    entries = read(disk)
    texts = str(entries)
    assert "Budi" not in texts
    assert "Ada" in texts
    marked = [entry.event.name for entry in entries if not isinstance(entry, JournalJump) and entry.redacted]
    assert marked == ["heard", "go"]
    assert not [entry for entry in entries if entry.redacted and getattr(entry, "digest", "")]
    again = Recorded(disk.folder, bundles={PROJECT.hash: PROJECT}).again()
    assert not [row for row in again if row.differs]
    assert [row.unknown for row in again if row.unknown] == ["an entry names a visitor whose data was deleted"] * 2
    assert again[-1].step is not None


def test_who_comes_home_with_each_step_and_remembers_much_fills_no_disk(disk: Disk) -> None:
    """The snapshot is written after as many bytes of other entries; everything still replays."""
    machine = Machine.from_dict(
        {
            "context": {"n": 0, "all": [f"word {n}" for n in range(10_000)]},
            "states": {"idle": {"on": {"go": {"target": "idle", "reenter": True}}}},
        }
    )
    writer, told = JournalWriter(disk), [initial(machine)]
    writer.start()
    writer.jumped("start", bundle(machine), told[0].snapshot)
    for number in range(500):
        told.append(step(machine, told[-1].snapshot, Event("go", {"why": "x" * 500}, number * 0.1)))
        assert told[-1].entered == ("idle",)
    tell(writer, told[1:])
    assert writer.flush(60.0)
    writer.close(HANG)
    standing = [entry for entry in read(disk) if len(line_of(entry)) > 100_000]
    assert 2 <= len(standing) < 6
    again = Recorded(disk.folder, bundles={machine.hash: bundle(machine)}).again()
    assert not [row for row in again if row.differs or row.unknown]


def test_a_frame_is_no_larger_than_a_reader_takes(disk: Disk, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(journal_writer, "MAX_LINES_BYTES", 2_000)
    monkeypatch.setattr(journal_file, "MAX_TEXT_BYTES", 10_000)
    disk.free.clear()
    writer, made = begun(disk), steps(200)
    tell(writer, made)  # all waits while the disk does not answer
    disk.free.set()
    writer.close(HANG)
    assert len([entry for entry in read(disk) if not isinstance(entry, JournalJump)]) == len(made)
    assert all(read_journal(file).whole for file in disk.files())


def test_a_flush_waits_for_what_was_told_while_the_disk_was_being_synced(
    disk: Disk, monkeypatch: pytest.MonkeyPatch
) -> None:
    syncing, synced = threading.Event(), threading.Event()

    class Wakes(threading.Event):
        """The flush has begun to wait: the sync may end."""

        def set(self) -> None:
            super().set()
            if syncing.is_set():
                synced.set()

    def fsync(file: int) -> None:
        syncing.set()
        assert synced.wait(HANG)

    monkeypatch.setattr("os.fsync", fsync)
    writer = begun(disk)
    writer._wake = Wakes()
    tell(writer, steps(3))
    assert syncing.wait(HANG)
    disk.free.clear()
    tell(writer, steps(3))
    assert not writer.flush(0.1)
    disk.free.set()
    assert writer.flush(HANG)
    writer.close(HANG)
