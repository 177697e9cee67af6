"""Transitions that wait for GO: the event waits, the chart does not, and nothing is lost without a word."""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from unittest.mock import Mock

import pytest

import lumen
from lumen.bus import Bus, connect
from lumen.bus.checking import SchemaCheck
from lumen.language.events import Event
from lumen.project.home import Home
from lumen.run.approvals import Approvals
from lumen.run.decisions import Decisions
from lumen.run.exhibition import Exhibition
from lumen.run.reload.records import RunRecords
from tests import ROOT
from tests.app.test_now import Asker, asker

STATE = ROOT / "schemas/messages/state.schema.json"
MINE = """
context: {n: 0, who: ""}
events: {dance: {}, other: {}, sing: {}, back: {}, leave: {}}
states:
  hall:
    on:
      dance: {target: stage, approve: operator, actions: {assign: {who: event.data.who}}}
      sing: {target: stage, approve: {by: operator, within: 20s, else: go}}
      other: {approve: {by: operator, within: 5s}, actions: {assign: {n: context.n + 1}}}
      leave: street
  stage: {on: {back: hall}}
  street: {}
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "behaviors" / "stories").mkdir(parents=True)
    (tmp_path / "behaviors" / "mine.yaml").write_text(MINE)
    (tmp_path / "lumen.yaml").write_text(
        "name: Mine\nbehavior: mine\nlanguages: [en]\nrobot: {name: NAO, model: nao}\nhall: hall.xml\n"
    )
    return tmp_path


@pytest.fixture
def bus() -> Bus:
    return connect("memory://")


@pytest.fixture
def exhibition(folder: Path, bus: Bus) -> Iterator[Exhibition]:
    with lumen.open(folder, bus=bus) as one:
        yield one


@pytest.fixture
def ask(exhibition: Exhibition, bus: Bus) -> Asker:
    return asker(exhibition, bus)


def raised(exhibition: Exhibition, event: str, data: Any = None) -> None:
    exhibition.loop.happen(Event(event, data))
    exhibition.run(0.1)


def test_modules_hear_what_waits_and_what_became_of_it(exhibition: Exhibition, ask: Asker, bus: Bus) -> None:
    heard: list[dict[str, Any]] = []
    bus.subscribe("lumen.NAO.state", lambda message: heard.append(message.body))
    check = SchemaCheck(json.loads(STATE.read_text("utf-8")))

    def told() -> list[dict[str, Any]]:
        exhibition.run(0.1)
        found = [body for body in heard if "approval" in body]
        assert [check(body) for body in found] == [""] * len(found)
        assert not check({**found[0], "approval": {"became": "goes"}})
        assert check({**found[0], "approval": {"became": "maybe"}})
        heard.clear()
        return [body["approval"] for body in found]

    raised(exhibition, "sing")
    [waits] = told()
    assert (waits["id"], waits["event"], waits["became"], waits["why"]) == ("a1", "sing", "waits", "")
    assert (waits["source"], waits["targets"], waits["file"]) == ("hall", ["stage"], "behaviors/mine.yaml")
    assert (waits["line"], waits["else"]) == (8, "go")
    assert waits["until"] == pytest.approx(waits["since"] + 20.0)
    exhibition.behavior.trace.standing(exhibition.loop.runtime.snapshot)  # a visitor has come
    assert told() == [waits]
    ask("approve", id="a1", go=True, by="Aisyah")
    assert [(one["became"], one["why"]) for one in told()] == [("goes", "Aisyah")]
    ask("event", event="back")
    raised(exhibition, "dance")
    ask("event", event="leave")
    assert [(one["event"], one["became"], one["until"]) for one in told()] == [
        ("dance", "waits", None),
        ("dance", "stays", None),
    ]


def test_an_event_waits_for_go_and_happens_as_it_was(exhibition: Exhibition, ask: Asker) -> None:
    raised(exhibition, "dance", {"who": "Budi"})
    raised(exhibition, "dance", {"who": "Ani"})
    assert exhibition.configuration == {"hall"}
    now = ask("now")
    [waiting] = now["waiting"]
    assert (waiting["event"], waiting["source"], waiting["targets"]) == ("dance", "hall", ["stage"])
    assert (waiting["until"], waiting["else"], waiting["file"], waiting["line"]) == (
        None,
        "stay",
        "behaviors/mine.yaml",
        7,
    )
    assert now["autonomy"] == "ask"
    assert ask("approve", id="a99", go=True, by="Aisyah")["verdict"] == "refused"
    assert ask("approve", id=waiting["id"], go=True, by="Aisyah") == {"verdict": "done"}
    exhibition.run(0.1)
    assert exhibition.configuration == {"stage"}
    assert exhibition.context["who"] == "Budi"
    assert ask("now")["waiting"] == []
    last = exhibition.why("stage")["chain"][-1]
    assert (last["kind"], last["text"]) == ("person", "Aisyah")


def test_what_is_not_approved_stays(exhibition: Exhibition, ask: Asker) -> None:
    raised(exhibition, "dance", {"who": "Budi"})
    assert ask("approve", id="", go=False, by="Aisyah") == {"verdict": "done"}
    exhibition.run(1.0)
    assert (exhibition.configuration, exhibition.context["who"]) == ({"hall"}, "")


def test_a_time_after_which_it_goes_or_stays(exhibition: Exhibition, ask: Asker) -> None:
    raised(exhibition, "other")
    raised(exhibition, "sing")
    assert [held["else"] for held in ask("now")["waiting"]] == ["stay", "go"]
    exhibition.run(6.0)
    assert exhibition.context["n"] == 0
    assert len(ask("now")["waiting"]) == 1
    exhibition.run(13.0)
    assert exhibition.configuration == {"hall"}
    exhibition.run(2.0)
    assert exhibition.configuration == {"stage"}


def test_what_waits_is_dropped_where_its_state_is_left(exhibition: Exhibition, ask: Asker) -> None:
    raised(exhibition, "dance", {"who": "Budi"})
    raised(exhibition, "leave")
    assert exhibition.configuration == {"street"}
    assert ask("now")["waiting"] == []
    assert ask("approve", id="", go=True)["reason"].endswith("none is waiting")


def test_alone_it_goes_by_itself_and_so_does_what_waits(exhibition: Exhibition, ask: Asker) -> None:
    raised(exhibition, "dance", {"who": "Budi"})
    assert ask("autonomy", level="alone", by="Aisyah") == {"verdict": "done", "autonomy": "alone"}
    exhibition.run(0.1)
    assert exhibition.configuration == {"stage"}
    raised(exhibition, "back")
    raised(exhibition, "dance", {"who": "Ani"})
    assert exhibition.context["who"] == "Ani"
    assert ask("autonomy", level="sometimes")["verdict"] == "refused"


def test_who_raises_an_event_hears_that_it_waits(ask: Asker) -> None:
    answer = ask("event", event="dance", data={"who": "Budi"}, by="Aisyah")
    assert answer == {"verdict": "done", "taken": False, "waiting": "a1"}


@pytest.mark.process
def test_a_reload_keeps_what_waits_as_far_as_it_is_marked(folder: Path, bus: Bus) -> None:
    with lumen.open(folder, bus=bus) as exhibition:
        ask = asker(exhibition, bus)
        raised(exhibition, "dance", {"who": "Budi"})
        raised(exhibition, "sing")
        file = folder / "behaviors" / "mine.yaml"
        file.write_text(
            MINE.replace("sing: {target: stage, approve: {by: operator, within: 20s, else: go}}", "sing: stage")
        )
        assert exhibition.reload().verdict == "applied"
        assert [held["event"] for held in ask("now")["waiting"]] == ["dance"]
        file.write_text(MINE)
        assert exhibition.reload().verdict == "applied"
        assert [held["event"] for held in ask("now")["waiting"]] == ["dance"]


def test_a_story_approves(folder: Path) -> None:
    (folder / "behaviors" / "stories" / "go.yaml").write_text(
        """
steps:
  - event: {name: dance, data: {who: Budi}}
  - expect: {state: hall}
  - operator: {approve: go}
  - expect: {state: stage, context: {who: Budi}}
  - event: back
  - operator: {autonomy: alone}
  - event: {name: dance, data: {who: Ani}}
  - expect: {state: stage, context: {who: Ani}}
"""
    )
    (folder / "behaviors" / "stories" / "none.yaml").write_text("steps: [{operator: {approve: go}}]")
    assert played(folder, "go") == ""
    assert "nothing is waiting for approval" in played(folder, "none")


def played(folder: Path, story: str) -> str:
    """Return why the story failed, or an empty string if it passed."""
    with lumen.open(folder, story=story) as exhibition:
        exhibition.run(60.0)
        player = exhibition.player
        assert player
        assert player.finished
        return player.failure


def test_a_crash_keeps_autonomy_and_says_what_is_lost(tmp_path: Path) -> None:
    home, told, narrator = Home(tmp_path), list[Any](), Mock()
    records = RunRecords(home)
    approvals = Approvals()
    Decisions(approvals, narrator, told.append, records.keep_decisions).autonomy("alone", "Aisyah")
    records.close()
    kept = RunRecords(home).decisions()
    assert kept == {"autonomy": "alone", "waiting": []}
    assert told == [{"autonomy": "alone", "by": "Aisyah"}]
    after = Approvals()
    Decisions(after, narrator, told.append, Mock()).recover({**kept, "waiting": ["dance"]}, resumed=True)
    assert after.autonomy == "alone"
    assert told[-1] == {"approval": "lost", "event": "dance"}
    narrator.line.assert_called_with("operator", "dance waited for GO, and is lost because the engine ended")
    fresh = Approvals()
    Decisions(fresh, narrator, told.append, Mock()).recover(kept, resumed=False)
    assert fresh.autonomy == "ask"


TALKS = """
phrases: {bye: {en: [bye]}}
states:
  hall:
    on:
      heard: {guard: "heard(event.data.result, 'bye')", target: "#leaving", approve: operator}
  leaving:
    id: leaving
    do: [{say: "Goodbye!"}, {posture: StandInit}, {say: "See you."}]
    onDone: hall
"""
HEARD = "routes: {heard: {key: lumen.heard, direction: in, schema: speech.recognition, event: heard}}\n"


def test_who_decides_hears_the_words_and_what_comes_of_them(folder: Path) -> None:
    """A waiting event lists the robot's actions until the next transition, in order, and `now` the visitor's words."""
    (folder / "behaviors" / "mine.yaml").write_text(TALKS)
    with (folder / "lumen.yaml").open("a") as main:
        main.write(HEARD)
    bus = connect("memory://")
    with lumen.open(folder, bus=bus) as one:
        raised(one, "heard", {"result": "bye bye", "language": "en"})
        now = asker(one, bus)("now")
        [waiting] = now["waiting"]
        assert waiting["data"]["result"] == now["visitor_said"]["text"] == "bye bye"
        assert [deed.get("text") or deed.get("name") for deed in waiting["would"]] == [
            "Goodbye!",
            "StandInit",
            "See you.",
        ]
        assert one.configuration == {"hall"}
