"""The journal asked for page by page: the last entries from memory, older ones from the files, each once."""

from pathlib import Path
from typing import Any

import pytest

import lumen
from lumen.insight.replay.entries import entry_data
from lumen.journal import journal_writer
from lumen.journal.journal_file import read_journal
from lumen.journal.journal_folder import JournalFolder, JournalTail
from lumen.journal.journal_writer import JournalWriter
from lumen.language.events import CLOCK_SET, Event
from lumen.language.people import PersonName
from lumen.run.asking import operator_key
from lumen.run.exhibition import Exhibition
from lumen.run.journal_pages import MAX_PAGE_BYTES, journal_page
from lumen.statechart import Step, initial, step
from tests.journal.test_writing import MACHINE, PROJECT, Disk, steps, tell
from tests.tour.conftest import copy
from tests.waiting import HANG, Collector, until

__all__ = ["copy"]


@pytest.fixture
def disk(tmp_path: Path) -> Disk:
    return Disk(tmp_path)


def begun(folder: JournalFolder | None, tail: JournalTail | None = None) -> JournalWriter:
    writer = JournalWriter(folder)
    writer.tail = tail or writer.tail
    writer.start()
    writer.jumped("start", PROJECT, initial(MACHINE).snapshot)
    return writer


def named(*names: str) -> list[Step]:
    """Return the steps of visitors who give their names one after another."""
    told = [initial(MACHINE)]
    for name in names:
        for event in (Event("come"), Event("heard", {"name": name}), Event("go")):
            told.append(step(MACHINE, told[-1].snapshot, event._replace(at=len(told) * 1.0)))
    return told[1:]


def whole(writer: JournalWriter, position: int = 0, most: int = 7) -> list[dict[str, Any]]:
    """Return the entries of all pages from `position` on."""
    found = list[dict[str, Any]]()
    while (page := journal_page(writer, position, most))["entries"]:
        assert page["run"] == writer.run
        assert page["next"] > position
        found, position = found + page["entries"], page["next"]
    assert page["next"] == writer.tail.next
    return found


def from_files(disk: Disk) -> list[dict[str, Any]]:
    return [
        {"position": entry.position, **entry_data(entry)}
        for file in disk.files()
        for entry in read_journal(file).entries
    ]


def test_the_last_entries_need_no_file(disk: Disk) -> None:
    writer = begun(disk)
    tell(writer, steps(60))
    assert writer.flush(HANG)
    kept = from_files(disk)
    for file in disk.files():
        file.unlink()
    assert whole(writer) == kept
    assert [entry["position"] for entry in kept] == list(range(writer.tail.next))
    writer.close()


def test_older_ones_come_from_the_files_and_each_comes_once(disk: Disk, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(journal_writer, "FILE_BYTES", 500)
    writer = begun(disk, JournalTail(10))
    for at in range(0, 60, 6):
        tell(writer, steps(60)[at : at + 6])
        assert writer.flush(HANG)
    assert len(disk.files()) > 2
    assert writer.tail.first == writer.tail.next - 10
    assert whole(writer) == from_files(disk)
    assert whole(writer, 33) == from_files(disk)[33:]
    writer.close()


def test_what_the_disk_refuses_is_told_and_keeps_its_position(disk: Disk, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(journal_writer, "RETRY_PERIOD", 0.0)
    writer, made = begun(disk, JournalTail(40)), steps(90)
    for full, at in ((False, 0), (True, 30), (False, 60)):
        disk.full = full
        tell(writer, made[at : at + 30])
        assert writer.flush(HANG)
    assert writer.lost
    told = whole(writer)
    assert [entry["position"] for entry in told[-40:]] == list(range(writer.tail.first, writer.tail.next))
    assert [entry for entry in from_files(disk) if entry not in told] == []
    writer.close()


def test_who_went_on_further_than_the_disk_is_led_back(disk: Disk) -> None:
    writer = begun(disk)
    assert writer.flush(HANG)
    assert journal_page(writer, 10_000) == {"entries": [], "next": writer.tail.next, "run": writer.run, "epoch": None}
    assert journal_page(writer, -5)["entries"] == whole(writer)
    writer.close()
    assert begun_after(disk).tail.next == writer.tail.next + 1


def begun_after(disk: Disk) -> JournalWriter:
    writer = begun(disk)
    writer.close()
    return writer


def test_without_a_journal_the_last_of_it_is_in_memory(tmp_path: Path) -> None:
    writer = begun(None, JournalTail(10))
    tell(writer, steps(60))
    assert writer.flush(HANG)
    assert not writer.lost
    told = whole(writer)
    assert [entry["position"] for entry in told] == list(range(writer.tail.next - 10, writer.tail.next))
    writer.close()


def test_memory_is_bounded_by_entries_and_by_bytes() -> None:
    tail = JournalTail(100, 1_000)
    for number in range(50):
        tail.add([b"x" * 30] * number)
        assert len(tail.since(0, 1_000)) <= 33
    tail.add([b"x" * 2_000])
    assert tail.since(0, 10) == []
    assert tail.first == tail.next == sum(range(50)) + 1


def test_a_page_has_its_date_also_after_the_entry_that_said_it(disk: Disk) -> None:
    for folder in (disk, None):
        writer = JournalWriter(folder)
        writer.tail = JournalTail(10)
        writer.start()
        made = [initial(MACHINE, epoch=1_000.0)]
        writer.jumped("start", PROJECT, made[0].snapshot)
        for number in range(30):
            name, data = (
                (CLOCK_SET, {"epoch": 2_000.0, "timezone": ""}) if number == 14 else ("heard", {"name": "epoch"})
            )
            sendid = CLOCK_SET if name == CLOCK_SET else ""
            made.append(step(MACHINE, made[-1].snapshot, Event(name, data, number * 1.0, sendid)))
        tell(writer, made[1:21])
        assert writer.flush(HANG)
        dates = {at: journal_page(writer, at, 1)["epoch"] for at in range(writer.tail.first, writer.tail.next)}
        assert dates == {at: 1_000.0 if at <= 15 else 2_000.0 for at in range(11, 21)}
        tell(writer, made[21:])
        assert writer.flush(HANG)
        assert {journal_page(writer, at)["epoch"] for at in range(writer.tail.first, writer.tail.next)} == {2_000.0}
        writer.close()


def test_a_page_is_bounded_by_its_bytes() -> None:
    writer = begun(None)
    big = [Event("heard", {"name": "x" * 100_000}, number * 1.0) for number in range(8)]
    told = [initial(MACHINE)]
    for event in big:
        told.append(step(MACHINE, told[-1].snapshot, event))
    tell(writer, told[1:])
    assert writer.flush(HANG)
    assert len(str(journal_page(writer, 1))) < MAX_PAGE_BYTES + 10_000
    assert len(whole(writer)) == 1 + len(big)
    writer.close()


def test_who_is_forgotten_is_in_no_page(disk: Disk) -> None:
    for folder in (disk, None):
        writer = begun(folder)
        tell(writer, named("Budi", "Ada"))
        writer.forget(PersonName("budi"))
        tell(writer, named("Eko"))
        assert writer.flush(HANG)
        told = whole(writer)
        assert "Budi" not in str(told)
        assert "Ada" in str(told)
        assert "Eko" in str(told)
        assert [entry["position"] for entry in told] == list(range(writer.tail.next))
        writer.close()


def test_what_a_name_can_be_tried_against_is_forgotten_too() -> None:
    writer = begun(None, JournalTail(4))
    tell(writer, named("Budi", "Ada"))
    assert writer.flush(HANG)
    assert [entry["digest"] for entry in whole(writer) if "digest" in entry]
    writer.forget(PersonName("budi"))  # who was named before the first entry that is in memory
    assert writer.flush(HANG)
    assert not [entry for entry in whole(writer) if "digest" in entry]
    writer.close()


def journal_of(exhibition: Exhibition) -> JournalWriter:
    writer = exhibition.loop.runtime.recorder
    assert isinstance(writer, JournalWriter)
    assert writer.flush(HANG)
    return writer


@pytest.mark.slow
def test_a_running_exhibition_is_asked(copy: Path) -> None:
    with lumen.open(copy) as exhibition:
        exhibition.send("face", {"x": 160, "y": 120})
        exhibition.run(3.0)
        answers, journal = Collector(), journal_of(exhibition)
        exhibition.node.bus.subscribe("lumen.test.answer", answers)
        for first in (0, 2):
            body = {"ask": "journal", "from": first}
            exhibition.node.bus.publish(operator_key("NAO"), body, reply_to="lumen.test.answer")
            exhibition.run(0.02)
            until(lambda number=first // 2: len(answers.bodies) > number)
            page = answers.bodies[-1]
            assert page["entries"][0]["position"] == first
            assert page["entries"] == journal_page(journal, first)["entries"][: len(page["entries"])]
        for wrong in ("soon", True, 0.5, None):
            exhibition.node.bus.publish(
                operator_key("NAO"), {"ask": "journal", "from": wrong}, reply_to="lumen.test.answer"
            )
        exhibition.run(0.02)
        until(lambda: len(answers.bodies) == 6)
        assert {page["reason"] for page in answers.bodies[2:]} == {
            "`from` must be a whole number: the position of an entry"
        }


@pytest.mark.slow
@pytest.mark.parametrize("kept", ["keep: 30", "keep: 0"])
def test_a_page_tells_of_this_run_also_where_nothing_is_kept(copy: Path, kept: str) -> None:
    with (copy / "lumen.yaml").open("a", encoding="utf-8") as file:
        file.write(f"\njournal: {{{kept}}}\n")
    with lumen.open(copy) as exhibition:
        exhibition.send("face", {"x": 160, "y": 120})
        exhibition.run(3.0)
        told = whole(journal_of(exhibition))
    assert told[0]["jump"] == "start"
    assert [entry["position"] for entry in told] == list(range(len(told)))
    assert "face" in [entry.get("heard") for entry in told]
    assert len(list((copy / ".lumen").rglob("*.journal"))) == (kept == "keep: 30")


@pytest.mark.slow
def test_who_wants_no_journal_any_more_keeps_none_of_before(copy: Path) -> None:
    for line in ("", "\njournal: {keep: 0}\n"):
        with (copy / "lumen.yaml").open("a", encoding="utf-8") as file:
            file.write(line)
        with lumen.open(copy) as exhibition:
            exhibition.run(0.1)
        assert len(list((copy / ".lumen").rglob("*.journal"))) == (not line)
