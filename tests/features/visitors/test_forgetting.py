"""The database forgets one person: whole visits, even a current one, and older rows; other people's rows stay."""

import sqlite3
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from lumen.bus import Bus
from lumen.features.visitors.module import JournalEntry, Store
from lumen.features.visitors.visit import SILENCE
from tests.features.conftest import Stand
from tests.features.visitors.test_memory import FACT, JOURNAL, Calendar, entries, remembering, talk

Make = Callable[..., Stand]


def hear(bus: Bus, text: str) -> None:
    bus.publish("lumen.audio.speech.recognition", {"name": "visitor", "result": text})


def context(bus: Bus, name: str, *, step: bool = True) -> None:
    """Publish that the behaviour knows that name, after a step of the behaviour or without one."""
    stepped = {"entered": [], "exited": [], "event": "heard"} if step else {}
    bus.publish("lumen.state", {"robot": "NAO", "time": 1.0, **stepped, "context": {"visitor": name}})


def forget(here: Stand, name: str) -> Any:
    return here.ask(FACT, {"method": "forget", "name": name})


def texts(here: Stand) -> list[str]:
    return [text for _, _, text in entries(here)]


def test_what_was_said_before_the_name_was_known_belongs_to_the_visit(stand: Make) -> None:
    here = stand()
    remembering(here, None)
    hear(here.bus, "I live in Bandung")
    talk(here.bus, "Ani")
    talk(here.bus, "Budi")
    forget(here, "ani")
    assert "I live in Bandung" not in texts(here)
    assert texts(here)[1:] == ["my name is Budi", "Budi", "how_are_you", "How are you?", "idle"]


@pytest.mark.parametrize(("name", "called"), [("Ünal", "u\u0308NAL"), ("İpek", "ipek"), ("José", "jose\u0301")])
def test_however_the_name_is_written(stand: Make, tmp_path: Path, name: str, called: str) -> None:
    here = stand()
    remembering(here, tmp_path / "memory.db")
    talk(here.bus, name)
    assert forget(here, called)["visitors"] == 1
    assert texts(here) == ["idle"]
    for module in here.modules:
        module.close()
    assert [file for file in tmp_path.iterdir() if name.encode() in file.read_bytes()] == []


def test_somebody_whose_name_holds_it_stays(stand: Make) -> None:
    here = stand()
    remembering(here, None)
    talk(here.bus, "Ana Maria")
    talk(here.bus, "Ana")
    found = forget(here, "ana")
    assert (found["visitors"], found["others"]) == (1, ["Ana Maria"])
    assert [v["name"] for v in here.ask(FACT, {"method": "list"})["visitors"]] == ["Ana Maria"]
    assert texts(here) == ["my name is Ana Maria", "Ana Maria", "how_are_you", "How are you?", "idle"]


def test_who_is_only_named_by_another_loses_that_row_alone(stand: Make) -> None:
    here = stand()
    remembering(here, None)
    here.ask(FACT, {"method": "remember", "name": "Budi", "data": {"friend": "Ani", "likes": "tea"}})
    hear(here.bus, "my friend Ani told me of you\nand I came")
    talk(here.bus, "Budi")
    assert forget(here, "Ani")["entries"] == 1
    assert here.ask(FACT, {"method": "recall", "name": "Budi"})["visitor"]["data"] == {"friend": "", "likes": "tea"}
    assert len(texts(here)) == 5


def test_the_name_is_found_beside_an_escape_of_json(stand: Make) -> None:
    here = stand()
    remembering(here, None)
    here.bus.publish(JOURNAL, {"kind": "note", "text": "x", "more": {"said": "so:\nAni\n"}})
    assert forget(here, "Ani")["entries"] == 1


def test_who_is_forgotten_while_standing_there_is_not_noted_again(stand: Make) -> None:
    here = stand()
    remembering(here, None)
    hear(here.bus, "my name is Ani")
    context(here.bus, "Ani")
    assert forget(here, "Ani")["entries"] == 2
    hear(here.bus, "I like dancing")
    context(here.bus, "Ani")  # a foreign behaviour that ignores the request to forget
    hear(here.bus, "Ani likes dancing")
    here.ask(JOURNAL, {"kind": "note", "text": "the projector was moved"})
    here.ask(JOURNAL, {"kind": "note", "text": "Ani moved it"})
    assert entries(here) == [("note", "", "the projector was moved")]
    context(here.bus, "")
    talk(here.bus, "Ani")
    assert len(entries(here)) == 6, "who comes again, and says their name again, is another visit"


def test_nor_where_the_behaviour_has_forgotten_the_name_with_them(stand: Make) -> None:
    here, date = stand(), Calendar()
    remembering(here, None, date)
    context(here.bus, "Ani")
    forget(here, "Ani")
    context(here.bus, "", step=False)
    hear(here.bus, "but I am Ani")
    context(here.bus, "")
    hear(here.bus, "I like dancing")
    assert entries(here) == []
    here.settle()
    date.now += SILENCE + 1.0
    hear(here.bus, "hello")
    assert texts(here) == ["hello"], "after so long it is somebody else"


def test_nor_where_the_name_was_said_and_not_understood_yet(stand: Make) -> None:
    here = stand()
    remembering(here, None)
    hear(here.bus, "my name is Ani")
    forget(here, "Ani")
    context(here.bus, "Ani")
    hear(here.bus, "I like dancing")
    assert entries(here) == []


def test_whom_the_eyes_alone_knew_is_forgotten_with_the_visit(stand: Make) -> None:
    here, date = stand(), Calendar()
    remembering(here, None, date)
    here.bus.publish("lumen.visual.face.recognition", {"name": "Ani"})
    hear(here.bus, "I live in Bandung")
    here.settle()
    date.now += SILENCE + 1.0
    here.bus.publish("lumen.visual.face.recognition", {"name": "Ani"})  # mistaken
    hear(here.bus, "I live in Jakarta")
    context(here.bus, "Budi")
    forget(here, "Ani")
    assert texts(here) == ["I live in Jakarta", "Budi"]


def test_a_visit_goes_on_after_the_memory_was_begun_anew(stand: Make, tmp_path: Path) -> None:
    file, date = tmp_path / "memory.db", Calendar()
    for name in ("", "Ani"):
        here = stand()
        remembering(here, file, date)
        hear(here.bus, "I live in Bandung")
        context(here.bus, name)
        here.settle()
        if not name:
            here.close()
    assert forget(here, "Ani")["entries"] == 3
    assert entries(here) == []


def test_what_could_not_be_forgotten_is_when_the_database_can_be_written(stand: Make, tmp_path: Path) -> None:
    file = tmp_path / "memory.db"
    here = stand()
    memory = remembering(here, file)
    talk(here.bus, "Wulandari")
    here.settle()
    other = sqlite3.connect(file)
    other.execute("BEGIN EXCLUSIVE")
    assert not forget(here, "Wulandari")["ok"]
    other.rollback()
    other.close()
    memory.close()
    assert [found for found in tmp_path.iterdir() if b"Wulandari" in found.read_bytes()] == []


def test_nobody_without_a_name_is_remembered(stand: Make) -> None:
    here = stand()
    remembering(here, None)
    answer = here.ask(FACT, {"method": "remember", "name": "\u200b ", "data": {"likes": "tea"}})
    assert answer == {"ok": False, "reason": "`remember` takes a `name`"}
    assert here.ask(FACT, {"method": "list"})["visitors"] == []


FIRST = """
CREATE TABLE journal (
    id INTEGER PRIMARY KEY, time REAL NOT NULL, date TEXT NOT NULL, robot TEXT NOT NULL,
    visitor TEXT NOT NULL COLLATE NOCASE, kind TEXT NOT NULL, text TEXT NOT NULL, data TEXT NOT NULL
);
CREATE TABLE visitors (
    name TEXT PRIMARY KEY COLLATE NOCASE, first REAL NOT NULL, last REAL NOT NULL,
    visits INTEGER NOT NULL, data TEXT NOT NULL
);
INSERT INTO visitors VALUES ('Ünal', 1, 5, 2, '{}'), ('ünal', 3, 9, 1, '{}'), ('Ani', 2, 2, 1, '{}');
INSERT INTO journal VALUES (1, 1, '', 'NAO', 'Ünal', 'said', 'Hello', '{}');
INSERT INTO journal VALUES (2, 2, '', 'NAO', 'Ani', 'said', 'Hi', '{}');
"""


def test_a_database_of_before_is_brought_up_to_date(tmp_path: Path) -> None:
    file = tmp_path / "memory.db"
    with sqlite3.connect(file) as old:
        old.executescript(FIRST)
    old.close()
    store = Store(file)
    visitor = store.visitor("ÜNAL")
    assert visitor
    assert (visitor["first"], visitor["last"], visitor["visits"], len(store.visitors())) == (1, 9, 3, 2)
    store.add([JournalEntry(3.0, "NAO", "Ünal", "said", "Again", {}, 1)])
    assert store.forget("ÜNAL")[:2] == (1, 2)
    assert [e["text"] for e in store.journal()] == ["Hi"]
    store.close()
    assert Store(file).journal(visitor="ANI")[0]["visitor"] == "Ani"
