"""The page Day lists sentences of visitors, without names, with the row that took each and the rows that could have."""

import json
from collections.abc import Iterator
from contextlib import closing
from datetime import date
from pathlib import Path
from typing import Any

import orjson
import pytest
import yaml
from selenium.webdriver.common.keys import Keys

from lumen.features.console.day import Day, day_of
from lumen.features.console.kept_days import KeptDays
from lumen.insight.replay.entries import JournalInput, JournalJump, RecordedEntry, entry_data
from lumen.language.events import Event
from lumen.language.machines import MachineDefinition
from lumen.project.standalone import machine_from_dict
from lumen.run.new_saying import DAY_FILE
from lumen.statechart import initial, serialize
from tests.explaining.guide import guide, guide_in
from tests.features.console.conftest import Hosted
from tests.features.console.pages import Browser, Served
from tests.features.console.test_conversation import violations
from tests.features.console.viewer import Viewer
from tests.waiting import HANG, until

GUIDE = guide(context={"tries": 0, "visitor": "Budi"})
CHOICE = ["dance", "sing", "not dance|sing", "asked dance", "tour_of", "faq", "no|done", "else"]
QUIZ = {"states": {"ask": {"hears": {"right": "told", "else": "ask"}}, "told": {"type": "final"}}}
HALL = {
    "phrases": {"right": ["wood"], "halt": ["halt"]},
    "type": "parallel",
    "states": {
        "safety": {"states": {"moving": {"hears": {"halt": "still"}}, "still": {}}},
        "guide": {"states": {"quiz": {"invoke": {"behavior": "quiz", "onDone": "over"}}, "over": {}}},
    },
}


def entries(machine: MachineDefinition, *texts: str) -> Iterator[RecordedEntry]:
    """Yield the journal of a visitor who says these texts."""
    begun = initial(machine, language="en").snapshot
    yield JournalJump(0, "start", 0.0, "hash", "guide", json.loads(json.dumps(serialize(machine, begun))))
    for position, text in enumerate(texts, 1):
        yield JournalInput(position, "heard", Event("heard", {"result": text}, float(position)))


def day(machine: MachineDefinition, *texts: str) -> Day:
    return day_of(entries(machine, *texts), lambda *_: machine, date(1970, 1, 1))


def numbers(found: Day) -> Any:
    """Return the numbers of the page, from JSON."""
    return json.loads(orjson.dumps(found.to_json()))["numbers"]


def test_what_was_misunderstood_comes_first() -> None:
    told = numbers(day(GUIDE, "I'm Ani", "Dance, please", "hm", "hm", "No."))
    row = {"language": "en", "states": [["guide", "choice"]]}
    assert told["said"] == [
        {"text": "hm", "row": "else", "count": 2, **row},
        {"text": "I'm Ani", "row": "my_name", "count": 1, "language": "en", "states": [["guide", "ask_name"]]},
        {"text": "Dance, please", "row": "dance", "count": 1, **row},
        {"text": "No.", "row": "no|done", "count": 1, **row},
    ]
    assert told["rows"] == {"guide ask_name": ["my_name", "else"], "guide choice": CHOICE}


def test_names_that_are_known_are_taken_out() -> None:
    said = [one["text"] for one in numbers(day(GUIDE, "Budi wants you to   dance,\nBUDI!", "Budi", "?"))["said"]]
    assert said == ["wants you to dance, !"]


def test_all_that_hear_at_once_could_have_taken_it() -> None:
    quiz = machine_from_dict({**QUIZ, "phrases": HALL["phrases"]}, "quiz", {})
    hall = machine_from_dict(HALL, "hall", {"quiz": {**QUIZ, "phrases": HALL["phrases"]}})
    assert hall.invoked["quiz"].states.keys() == quiz.states.keys()
    told = numbers(day(hall, "it is wood", "halt", "is it glass", "what"))
    taken = {one["text"]: (one["states"], one["row"]) for one in told["said"]}
    both = [["guide", "safety.moving"], ["quiz", "ask"]]
    assert taken["it is wood"] == (both, "right")
    assert taken["halt"] == ([["guide", "safety.moving"]], "halt")
    assert "is it glass" not in taken
    assert told["rows"]["quiz ask"] == ["right", "else"]


def test_days_without_visits_are_not_offered_while_another_has_some() -> None:
    waiting = machine_from_dict(
        {"states": {"idle": {"on": {"heard": "talk"}}, "talk": {"on": {"bye": "idle"}}}}, "guide", {}
    )
    [begun] = entries(waiting)
    heard = JournalInput(1, "heard", Event("heard", {}, 86_400.0), entered=("talk",), exited=("idle",))
    assert day_of([begun], lambda *_: waiting, None).dates == [date(1970, 1, 1)]
    assert day_of([begun, heard], lambda *_: waiting, None).dates == [date(1970, 1, 2)]


def test_a_behaviour_without_rows_lists_nothing() -> None:
    still = machine_from_dict({"states": {"a": {"on": {"heard": "a"}}}}, "guide", {})
    assert numbers(day(still, "hello"))["said"] == []


def test_what_is_a_saying_by_now_leaves_the_list(tmp_path: Path) -> None:
    root = guide_in(tmp_path, mine="guide: {choice: {dance: {en: [Hop! Hop!]}}}\n")
    days = KeptDays(root)
    told = [{**entry_data(one), "position": one.position} for one in entries(GUIDE, "I'm Ani", "hop hop", "jump")]
    days._machine = lambda *_: GUIDE  # type: ignore[method-assign]  # what ran then
    assert [one.text for one in days.told([told], date(1970, 1, 1)).said] == ["I'm Ani", "jump"]


def test_where_the_files_of_that_day_are_gone_those_of_now_are_read(tmp_path: Path) -> None:
    told = [{**entry_data(one), "position": one.position} for one in entries(guide(), "I'm Ani", "jump")]
    found = KeptDays(guide_in(tmp_path)).told([told], date(1970, 1, 1))
    assert [(one.text, one.row) for one in found.said] == [("I'm Ani", "my_name"), ("jump", "else")]


@pytest.fixture(scope="module")
def hosted(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Hosted]:
    with closing(Hosted(guide_in(tmp_path_factory.mktemp("guide")))) as one:
        yield one


def test_an_author_adds_a_saying(hosted: Hosted) -> None:
    with closing(Served(hosted.root)) as served:
        until(lambda: any(robot["connected"] for robot in served.browser.robots))
        saying = {"behavior": "guide", "state": "choice", "row": "dance", "language": "en", "text": "hop hop"}
        assert served.browser.post("/api/sayings", saying).data == {"file": DAY_FILE}
        assert '- "hop hop"' in (hosted.root / DAY_FILE).read_text("utf-8")
        refused = served.browser.post("/api/sayings", {**saying, "row": "dnace"})
        assert refused.status == 400
        assert "has no row `dnace` (did you mean `dance`?" in refused.data["reason"]
        elsewhere = served.browser.post("/api/sayings", {**saying, "robot": "NAO7"})
        assert elsewhere.status == 404


@pytest.mark.slow
@pytest.mark.xdist_group("operating")
def test_a_page_lets_an_author_say_what_it_should_have_been(viewer: Viewer, hosted: Hosted) -> None:
    with closing(Served(hosted.root)) as served:
        until(lambda: any(robot["connected"] for robot in served.browser.robots))
        for text in ("I'm Ani", "Ani <b>jumps</b>"):
            hosted.send("heard", {"result": text, "language": "en"})
        until(lambda: len(Browser(served.console.address).get("/api/day").data["numbers"]["said"]) == 2, HANG)
        viewer.open(served.console.address, "robot/NAO/day", ready=".said li", mode="operator")
        assert viewer.text(".said li").startswith("Ani <b>jumps</b>")
        assert not viewer.all(".said button")
        viewer.open(served.console.address, "robot/NAO/day", ready=".said button", mode="author", language="id")
        viewer.shows("Yang dikatakan pengunjung", ".said")
        viewer.click(".said button")
        until(lambda: viewer.run("return document.activeElement.matches('.said select')"), HANG)
        assert violations(viewer) == []
        assert [option.text for option in viewer.all(".said option")] == ["", *CHOICE]
        viewer.type("not")
        viewer.run("document.querySelector('.said input').select()")
        viewer.type("Budi never jumps", Keys.ENTER)
        viewer.shows(f"disimpan sebagai {DAY_FILE}", ".said")
        assert "jumps" not in viewer.text(".said li")
    said = yaml.safe_load((hosted.root / DAY_FILE).read_text("utf-8"))["guide"]["choice"]
    assert said["not dance|sing"] == {"en": ["Budi never jumps"]}
