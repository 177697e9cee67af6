"""The database module: its entries, its answers, its deletions, and its errors if the file is unusable."""

import sqlite3
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from lumen.bus import Bus
from lumen.features.visitors.module import JournalEntry, Memory, Store
from lumen.language.projects import Project
from tests.features.conftest import Stand, with_options
from tests.waiting import until

FACT, JOURNAL = "lumen.NAO.persistence.fact", "lumen.NAO.persistence.journal"
DAY = 86_400.0


class Calendar:
    """A clock [s since 1970] that a test advances."""

    def __init__(self) -> None:
        self.now = 1_000 * DAY

    def __call__(self) -> float:
        return self.now


Make = Callable[..., Stand]


def remembering(stand: Stand, file: Path | None, date: Callable[[], float] = Calendar()) -> Memory:  # noqa: B008
    memory = Memory(stand.project, stand.bus, stand.told.append, file, date)
    stand.add(memory)
    return memory


def talk(bus: Bus, name: str) -> None:
    """Publish a whole visit: a visitor gives this name, gets an answer, and leaves."""
    bus.publish("lumen.audio.speech.recognition", {"name": "visitor", "result": f"my name is {name}"})
    bus.publish("lumen.state", {"robot": "NAO", "time": 1.0, "entered": ["how_are_you"], "context": {"visitor": name}})
    bus.publish(
        "lumen.state", {"robot": "NAO", "time": 1.0, "command": {"verb": "say", "id": "d1", "text": "How are you?"}}
    )
    bus.publish("lumen.state", {"robot": "NAO", "time": 1.0, "entered": ["idle"], "context": {"visitor": ""}})


def entries(stand: Stand, **question: Any) -> list[tuple[str, str, str]]:
    found = stand.ask(JOURNAL, {"method": "read", **question})
    assert found["ok"], found
    return [(e["kind"], e["visitor"], e["text"]) for e in found["entries"]]


def test_journals_what_was_heard_said_and_done(stand: Make, tmp_path: Path) -> None:
    here = stand()
    remembering(here, tmp_path / "memory.db")
    talk(here.bus, "Ani")
    assert entries(here) == [
        ("heard", "", "my name is Ani"),
        ("visitor", "Ani", "Ani"),
        ("state", "Ani", "how_are_you"),
        ("said", "Ani", "How are you?"),
        ("state", "", "idle"),
    ]
    assert (tmp_path / "memory.db").stat().st_mode & 0o077 == 0


def test_counts_visits_by_name_whatever_the_capitals(stand: Make) -> None:
    here, date = stand(), Calendar()
    remembering(here, None, date)
    talk(here.bus, "Ani")
    here.settle()
    date.now += DAY
    talk(here.bus, "ANI")
    visitor = here.ask(FACT, {"method": "recall", "name": "ani"})["visitor"]
    assert (visitor["visits"], visitor["last"] - visitor["first"]) == (2, DAY)
    assert here.ask(FACT, {"method": "recall", "name": "Budi"}) == {"ok": True, "visitor": None}


def test_remembers_facts_that_others_tell(stand: Make) -> None:
    here = stand()
    remembering(here, None)
    assert here.ask(FACT, {"method": "remember", "name": "Ani", "data": {"likes": "dancing"}})["ok"]
    here.ask(FACT, {"method": "remember", "name": "Ani", "data": {"from": "Bandung"}})
    (visitor,) = here.ask(FACT, {"method": "list"})["visitors"]
    assert visitor["data"] == {"likes": "dancing", "from": "Bandung"}


def test_entries_of_other_modules(stand: Make) -> None:
    here = stand()
    remembering(here, None)
    assert here.ask(JOURNAL, {"kind": "note", "text": "the projector was moved"}) == {"ok": True}
    assert entries(here) == [("note", "", "the projector was moved")]


def test_forgets_somebody_and_leaves_nothing_in_the_file(stand: Make, tmp_path: Path) -> None:
    here = stand()
    remembering(here, tmp_path / "memory.db")
    talk(here.bus, "Ani Wulandari")
    talk(here.bus, "Anita")
    here.bus.publish(JOURNAL, {"kind": "note", "text": "talked with ani wulandari", "about": "a robot"})
    gone = here.ask(FACT, {"method": "forget", "name": "ani wulandari"})
    assert gone == {"ok": True, "visitors": 1, "entries": 5}
    assert [text for _, _, text in entries(here)] == ["idle", "my name is Anita", "Anita", *["how_are_you"],
                                                      "How are you?", "idle"]  # fmt: skip
    for module in here.modules:
        module.close()
    for file in tmp_path.iterdir():
        assert b"Wulandari" not in file.read_bytes(), file


def test_what_another_program_still_reads_is_said_and_gone_once_it_is_closed(stand: Make, tmp_path: Path) -> None:
    file = tmp_path / "memory.db"
    here = stand()
    remembering(here, file)
    forgotten = here.listen("lumen.NAO.persistence.forgotten")
    talk(here.bus, "Wulandari")
    here.settle()
    other = sqlite3.connect(file, isolation_level=None)
    other.execute("BEGIN")
    assert len(other.execute("SELECT * FROM visitors").fetchall()) == 1
    answer = here.ask(FACT, {"method": "forget", "name": "Wulandari"})
    here.settle()
    assert answer == {"ok": False, "reason": here.told[0]}
    assert (
        here.told[0]
        == f"{file} is open in another program: close that program to remove the deleted entries from the file"
    )
    assert forgotten.bodies == [{"name": "Wulandari"}]
    other.close()
    assert Store(file).visitors() == []
    assert here.ask(FACT, {"method": "forget", "name": "Wulandari"})["ok"]
    assert [found for found in tmp_path.iterdir() if b"Wulandari" in found.read_bytes()] == []


def test_forget_without_a_name_deletes_nothing(stand: Make) -> None:
    here = stand()
    remembering(here, None)
    talk(here.bus, "Ani")
    assert here.ask(FACT, {"method": "forget"}) == {"ok": False, "reason": "`forget` takes a `name`"}
    assert len(entries(here)) == 5


def test_keeps_nothing_longer_than_it_says(stand: Make, project: Project) -> None:
    here, date = stand(with_options(project, "memory", keep=2)), Calendar()
    store = Store(None)
    for age in (3, 1):
        store.add([JournalEntry(date.now - age * DAY, "NAO", "", "heard", f"{age} days ago")])
        store.met(f"visitor {age}", date.now - age * DAY)
    assert store.expire(date.now - 2 * DAY) == 2
    assert [e["text"] for e in store.journal()] == ["1 days ago"]
    assert [v["name"] for v in store.visitors()] == ["visitor 1"]
    memory = remembering(here, None, date)
    talk(here.bus, "Ani")
    here.settle()
    date.now += 3 * DAY
    assert here.ask(JOURNAL, {"text": "much later"})["ok"]
    assert memory.settle(60.0)
    assert entries(here) == [("entry", "", "much later")]


def test_a_locked_database_is_one_line_and_nothing_is_lost(stand: Make, tmp_path: Path) -> None:
    file = tmp_path / "memory.db"
    Store(file).visitors()
    other = sqlite3.connect(file)
    other.execute("BEGIN EXCLUSIVE")
    here = stand()
    troubles = here.listen("lumen.trouble")
    remembering(here, file)
    talk(here.bus, "Ani")
    talk(here.bus, "Budi")
    answer = here.ask(FACT, {"method": "list"})
    assert (answer["ok"], answer["reason"].partition(" by another")[0]) == (False, f"{file} is locked")
    here.settle()
    assert here.told == [answer["reason"]]
    assert troubles.bodies == [{"module": "memory", "text": answer["reason"]}]
    other.rollback()
    other.close()
    assert len(entries(here)) == 10


def test_a_file_of_a_newer_lumen_is_left_as_it_is(stand: Make, tmp_path: Path) -> None:
    file = tmp_path / "memory.db"
    with sqlite3.connect(file) as db:
        db.execute("PRAGMA user_version = 99")
    db.close()
    before = file.read_bytes()
    here = stand()
    remembering(here, file)
    talk(here.bus, "Ani")
    until(lambda: here.told)
    assert "was written by a newer Lumen: use that version, or move the file away" in here.told[0]
    assert file.read_bytes() == before


@pytest.mark.parametrize(
    ("content", "said"),
    [(b"what is this?" * 100, "is not an SQLite database or is damaged"), (None, "is a database of another program")],
)
def test_a_file_that_is_something_else(stand: Make, tmp_path: Path, content: bytes | None, said: str) -> None:
    file = tmp_path / "memory.db"
    if content:
        file.write_bytes(content)
    else:
        with sqlite3.connect(file) as db:
            db.execute("CREATE TABLE visitors (name TEXT, shoe_size REAL)")
        db.close()
    here = stand()
    remembering(here, file)
    talk(here.bus, "Ani")
    until(lambda: here.told)
    assert said in here.told[0]
    assert len(here.told) == 1
    file.unlink()
    assert len(entries(here)) == 5


def test_senses_at_a_pace(stand: Make, project: Project) -> None:
    here, date = stand(with_options(project, "memory", sample=1)), Calendar()
    remembering(here, None, date)
    for _ in range(5):
        here.bus.publish("avatar.NAO.data.sonar", {"rightSensor": 0.5, "leftSensor": 2.5, "time": 1.0})
        here.settle()
        date.now += 0.5
    assert [kind for kind, _, _ in entries(here)] == ["sonar"] * 3


def test_text_that_no_file_holds_is_written_all_the_same(stand: Make, tmp_path: Path) -> None:
    here = stand()
    remembering(here, tmp_path / "memory.db")
    talk(here.bus, "An\ud800i")
    here.bus.publish(JOURNAL, {"text": "a\x00b", "kind": "\udfff", "note": "José \ud800"})
    assert [text for kind, _, text in entries(here)[:2]] == ["my name is An?i", "An?i"]
    assert here.ask(FACT, {"method": "recall", "name": "An\ud800i"})["visitor"]["visits"] == 1
    assert here.ask(FACT, {"method": "forget", "name": "josé"})["entries"] == 1


def test_tells_the_others_who_is_to_be_forgotten(stand: Make) -> None:
    here = stand()
    remembering(here, None)
    told = here.listen("lumen.NAO.persistence.forgotten")
    here.ask(FACT, {"method": "forget", "name": "Ani"})
    assert told.bodies == [{"name": "Ani"}]


def test_another_robots_behaviour_is_not_noted(stand: Make) -> None:
    here = stand()
    remembering(here, None)
    here.bus.publish(
        "lumen.state", {"robot": "PEPPER", "time": 1.0, "entered": ["idle"], "context": {"visitor": "Ani"}}
    )
    assert entries(here) == []
