"""Forks of a run: a replay, and one with another event or with the saved files."""

import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import lumen
from lumen.bus import connect
from lumen.insight.replay.entries import JournalInput
from lumen.journal.journal_folder import JournalFolder, JournalTail
from lumen.journal.journal_writer import JournalWriter
from lumen.language.events import Event
from lumen.language.iso_time import iso_time
from lumen.run import forking
from lumen.run.exhibition import Exhibition
from lumen.statechart import initial, step
from tests.app.test_now import Asker, asker
from tests.journal.test_writing import MACHINE, PROJECT, tell
from tests.waiting import HANG

MINE = """
context: {n: 0}
events: {left: {}, right: {}, more: {}}
states:
  hall:
    on: {left: red, right: blue}
  red:
    do: {say: Red}
    on: {more: {actions: {assign: {n: context.n + 1}}}}
    after: {10s: hall}
  blue:
    do: {say: Blue}
    on: {more: {actions: {assign: {n: context.n + 2}}}}
    after: {4s: hall}
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "behaviors").mkdir()
    (tmp_path / "behaviors" / "mine.yaml").write_text(MINE)
    (tmp_path / "lumen.yaml").write_text(
        "name: Mine\nbehavior: mine\nlanguages: [en]\nrobot: {name: NAO, model: nao}\nhall: hall.xml\n"
    )
    return tmp_path


@pytest.fixture
def ask(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Asker]:
    monkeypatch.setattr(forking, "PATIENCE", HANG)
    bus = connect("memory://")
    with lumen.open(folder, bus=bus) as exhibition:
        raised(exhibition, "left")
        raised(exhibition, "more")
        exhibition.run(12.0)
        yield asker(exhibition, bus)


def raised(exhibition: Exhibition, event: str) -> None:
    exhibition.loop.happen(Event(event))
    exhibition.run(1.0)


def position_of(ask: Asker, event: str) -> int:
    entries = ask("journal", **{"from": 0})["entries"]
    return next(int(entry["position"]) for entry in entries if entry.get("heard") == event)


def entered(entries: list[dict[str, Any]]) -> list[tuple[str, ...]]:
    return [tuple(entry["entered"]) for entry in entries if entry.get("entered")]


def test_nothing_else_is_what_was(ask: Asker) -> None:
    forked = ask("fork", position=position_of(ask, "left"))
    assert entered(forked["was"]) == entered(forked["would"]) == [("red",), ("hall",)]
    assert [entry["at"] for entry in forked["was"]] == [entry["at"] for entry in forked["would"]]
    assert "trouble" not in forked


def test_another_event_leads_elsewhere_and_all_else_happens_as_it_did(ask: Asker) -> None:
    forked = ask("fork", position=position_of(ask, "left"), event={"name": "right"})
    assert entered(forked["was"]) == [("red",), ("hall",)]
    assert entered(forked["would"]) == [("blue",), ("hall",)]
    heard = [entry.get("heard") for entry in forked["would"]]
    assert heard[0] == "right"
    assert "more" in heard
    later = [entry["at"] for entry in forked["would"] if entry.get("timer")]
    assert later[0] < next(entry["at"] for entry in forked["was"] if entry.get("timer"))


def test_the_saved_files_are_tried(ask: Asker, folder: Path) -> None:
    (folder / "behaviors" / "mine.yaml").write_text(MINE.replace("left: red", "left: blue"))
    position = position_of(ask, "left")
    assert entered(ask("fork", position=position, bundle="saved")["would"]) == [("blue",), ("hall",)]
    (folder / "behaviors" / "mine.yaml").write_text(MINE.replace("left: red", "left: rad"))
    refused = ask("fork", position=position, bundle="saved")
    assert refused["verdict"] == "refused"
    assert "mine.yaml:6" in refused["reason"]


def test_a_moment_says_where_too(ask: Asker) -> None:
    since = ask("now")["states"][0]["since"]
    assert ask("fork", at="2001-01-01T00:00:00Z")["was"] == ask("fork", position=0)["was"]
    assert ask("fork", at=since)["was"][0]["entered"] == ["hall"]


def test_a_moment_is_found_in_the_files_if_memory_begins_after_it(tmp_path: Path) -> None:
    writer = JournalWriter(JournalFolder(tmp_path, 1.0, 1.0))
    writer.tail = JournalTail(40)
    writer.start()
    epoch = time.time() + 1_000.0  # later than the beginning of the file, however slow the machine is
    made = [initial(MACHINE, epoch=epoch)]
    writer.jumped("start", PROJECT, made[0].snapshot)
    for number in range(90):
        made.append(step(MACHINE, made[-1].snapshot, Event("heard", {"name": "Eko"}, float(number))))
    tell(writer, made[1:])
    assert writer.flush(HANG)
    for at in (3.0, 89.0):
        entries, position = forking._entries(writer, {"at": iso_time(epoch + at - 0.5)})
        (found,) = [entry for entry in entries if entry.position == position]
        assert isinstance(found, JournalInput)
        assert found.event.at == at
    writer.close()


@pytest.mark.parametrize(
    ("body", "reason"),
    [
        ({}, "add `position`"),
        ({"at": "noon"}, "`noon` is not a time"),
        ({"position": 100_000}, "no event at or after position 100000"),
        ({"position": 1, "event": "left"}, "`event` must look like"),
    ],
)
def test_what_can_not_be_asked_is_said(ask: Asker, body: dict[str, Any], reason: str) -> None:
    answer = ask("fork", **body)
    assert answer["verdict"] == "refused"
    assert reason in answer["reason"]
