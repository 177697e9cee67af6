"""The brain's report of the present moment, and an event that a person triggers."""

import json
from collections.abc import Callable
from datetime import datetime
from pathlib import Path
from typing import Any

import pytest

import lumen
from lumen.bus import Bus, connect
from lumen.language.commands import Look, Play, Say, Start
from lumen.language.events import Event
from lumen.language.operator_requests import REQUESTS
from lumen.ports import Message
from lumen.run.activity_tracker import ActivityTracker
from lumen.run.asking import operator_key
from lumen.run.exhibition import Exhibition
from lumen.run.raised_events import person_in
from lumen.statechart.direct_entry import entered_directly
from tests import ROOT
from tests.app.test_request_checks import RIGHT
from tests.tables import for_each
from tests.waiting import until

ANSWERS = "test.answers"
Asker = Callable[..., dict[str, Any]]


def asker(exhibition: Exhibition, bus: Bus) -> Asker:
    """Return a function that sends a request and runs the exhibition until the answer arrives."""
    came: list[Any] = []
    bus.subscribe(ANSWERS, lambda message: came.append(message.body))

    def answered() -> bool:
        exhibition.tick()
        return bool(came)

    def send_request(what: str, **more: Any) -> dict[str, Any]:
        came.clear()
        bus.publish(operator_key("NAO"), {"ask": what, **more}, reply_to=ANSWERS)
        until(answered)
        return dict(came[0])

    return send_request


@pytest.mark.slow
def test_now_holds_the_status_and_what_can_happen_next(copy: Path) -> None:
    with lumen.open(copy) as exhibition:
        exhibition.send("face", {"x": 160, "y": 120})
        exhibition.run(0.5)
        now = exhibition.view()
        status = exhibition.status()
        assert {key: now[key] for key in status} == status
        json.dumps(now)
        [guide, *_] = now["states"]
        assert (guide["path"], guide["file"]) == ("guide", "behaviors/tour.yaml")
        [talking] = guide["children"]
        [greet] = talking["children"]
        assert (talking["name"], greet["name"], greet["children"]) == ("talking", "greet", [])
        line = Path(copy / greet["file"]).read_text().splitlines()[greet["line"] - 1]
        assert "greet" in line
        assert greet["since"] == status["since"]
        since = datetime.fromisoformat(now["time"]) - datetime.fromisoformat(greet["since"])
        assert 0.4 < since.total_seconds() < 0.6
        assert now["saying"]["text"]
        assert now["saying"]["language"] == "en"
        assert "heard" in now["events"]
        assert "dance" in now["motions"]
        assert "Stand" in now["postures"]
        timer = next(way for way in now["ways"] if way["event"] == "after 30 s")
        assert timer["due"] == status["timers"][0]["due"]
        assert timer["targets"] == ["goodbye"]
        assert timer["open"]
        named = next(way for way in now["ways"] if way["guard"] and way["guard"]["text"] == "context.visitor != ''")
        assert (named["open"], named["guard"]["true"], named["guard"]["values"]) == (
            False,
            False,
            {"context.visitor": ""},
        )
        assert named["why"] == "context.visitor != '' is false: context.visitor is \"\""
        exhibition.send("heard", {"name": "visitor", "result": "my name is Budi", "date": "", "language": "en"})
        exhibition.run(0.1)
        assert exhibition.view()["visitor_said"]["text"] == "my name is Budi"


@pytest.mark.slow
def test_a_motion_says_how_far_it_is(copy: Path) -> None:
    with lumen.open(copy) as exhibition:
        exhibition.run(5.0)
        runtime = exhibition.loop.runtime
        wanted = Event("operator.goto", {"state": "dance"}, exhibition.now)
        exhibition.loop.take(entered_directly(runtime.project.machine, runtime.snapshot, "dance", wanted))
        far = []
        for _ in range(600):
            exhibition.run(0.1)
            moved = exhibition.view()["motion"]
            if moved and moved["name"] == "dance":
                far.append(moved["progress"])
        assert far
        assert far == sorted(far)
        assert far[0] < 0.1
        assert 0.9 < far[-1] <= 1.0


MINE = """
context: {n: 0, who: ""}
events:
  next: {}
  named: {type: object, properties: {name: {type: string}, age: {type: integer}}, required: [name]}
  back: {}
states:
  waiting:
    on:
      next: {guard: "context.n < 1", target: shown, actions: {assign: {n: context.n + 1}}}
      named: {target: shown, actions: {assign: {who: event.data.name}}}
  shown:
    on: {back: waiting}
    states: {here: {}}
"""


@pytest.fixture
def mine(tmp_path: Path) -> Path:
    (tmp_path / "behaviors").mkdir()
    (tmp_path / "behaviors" / "mine.yaml").write_text(MINE)
    (tmp_path / "lumen.yaml").write_text(
        "name: Mine\nbehavior: mine\nlanguages: [en]\nrobot: {name: NAO, model: nao}\nhall: hall.xml\n"
    )
    return tmp_path


def test_a_person_lets_an_event_happen_and_hears_whether_it_was_taken(mine: Path) -> None:
    bus = connect("memory://", sender="panel")
    with lumen.open(mine, bus=bus) as exhibition:
        send_request = asker(exhibition, bus)
        before = send_request("now")
        assert (before["events"], before["saying"], before["motion"]) == (["back", "named", "next"], None, None)
        assert [s["name"] for s in before["states"]] == ["waiting"]
        assert send_request("event", event="next", by="Aisyah") == {"verdict": "done", "taken": True}
        now = send_request("now")
        assert [s["name"] for s in now["states"]] == ["shown"]
        assert [s["name"] for s in now["states"][0]["children"]] == ["shown.here"]
        until(lambda: send_request("now")["position"] > before["position"])  # it is kept on another thread
        assert send_request("event", event="next", by="Aisyah") == {"verdict": "done", "taken": False}
        assert send_request("event", event="back") == {"verdict": "done", "taken": True}
        assert exhibition.why("waiting")["chain"][-1]["text"] == "panel"
        closed = next(way for way in send_request("now")["ways"] if way["event"] == "next")
        assert (closed["open"], closed["why"]) == (False, "context.n < 1 is false: context.n is 1")
        assert send_request("event", event="named", data={"name": "Budi"}, by="Aisyah")["taken"]
        assert exhibition.context["who"] == "Budi"
        last = exhibition.why("shown")["chain"][-1]
        assert (last["kind"], last["text"]) == ("person", "Aisyah")


@for_each(
    "body,sender,named",
    [({"by": "Aisyah"}, "eyes", "Aisyah"), ({}, "eyes", "eyes"), ({"by": ""}, "", "a program on the bus")],
)
def test_who_asks_is_the_named_person_else_the_program(body: dict[str, str], sender: str, named: str) -> None:
    assert person_in(Message("lumen.operator", body, sender=sender)) == named


def test_the_data_of_an_event_is_as_declared_or_refused_with_what_would_be_right(mine: Path) -> None:
    """Data of an event must fit its declaration in `events:` of the behaviour, of the robot, or in a route's schema."""
    bus = connect("memory://")
    with lumen.open(mine, bus=bus) as exhibition:
        send_request = asker(exhibition, bus)
        right = ". It has `name` (string); `age` (integer), which may be left out"
        for data, wrong in (
            ({"name": 3}, "name: 3 is not of type 'string'"),
            ({}, "'name' is a required property"),
            (None, "'name' is a required property"),
            ({"name": "Budi", "age": "old"}, "age: 'old' is not of type 'integer'"),
        ):
            reason = f"the data of `named` is not as declared: {wrong}{right}"
            assert send_request("event", event="named", data=data) == {"verdict": "refused", "reason": reason}
        assert exhibition.context["who"] == ""
        assert "'sensor' is a required property" in send_request("event", event="touched", data={})["reason"]
        assert send_request("event", event="touched", data={"sensor": "head"})["verdict"] == "done"
        assert send_request("event", event="nobody.declares.this", data=[1])["verdict"] == "done"
        assert send_request("event", event="named", data={"name": "Budi"})["taken"]


def test_an_event_of_a_route_has_the_data_of_its_message(copy: Path) -> None:
    bus = connect("memory://")
    with lumen.open(copy, bus=bus) as exhibition:
        send_request = asker(exhibition, bus)
        assert send_request("event", event="face", data={"x": "left", "y": 120})["verdict"] == "refused"
        assert send_request("event", event="face", data={"x": 160, "y": 120})["verdict"] == "done"


def test_what_can_be_no_event_is_refused(mine: Path) -> None:
    bus = connect("memory://")
    with lumen.open(mine, bus=bus) as exhibition:
        send_request = asker(exhibition, bus)
        for event in ("", 3, None, "x" * 101):
            assert send_request("event", event=event) == {
                "verdict": "refused",
                "reason": "`event` must be the name of an event",
            }
        for event in ("done.command.d1", "shared.changed"):
            refused = send_request("event", event=event)
            assert refused["verdict"] == "refused"
            assert "only robots send it" in refused["reason"]
        assert '`{"ask": "now"}`' in send_request("nothing")["reason"]
        for row in REQUESTS:
            assert send_request(row.ask, **RIGHT.get(row.ask, {})), f"`{row.ask}` is not answered"


def test_a_text_of_somebody_else_is_told_as_long_as_it_takes(copy: Path) -> None:
    with lumen.open(copy) as exhibition:
        exhibition.run(0.1)
        exhibition.say("The museum closes soon.", "en")
        exhibition.run(0.1)
        assert exhibition.view()["saying"]["text"] == "The museum closes soon."
        exhibition.run(20.0)
        said = exhibition.view()["saying"]
        assert said is None or said["text"] != "The museum closes soon."


def test_a_command_waits_until_it_is_answered() -> None:
    activity = ActivityTracker(lambda: lumen.load(ROOT), lambda: None, lambda: 0.0)
    for id, command in (("c1", Look()), ("c2", Play("wave")), ("c3", Say("Hello!"))):
        activity.performing(Start(id, command), 0.0)
    assert activity.commands == 3
    for left, id in ((2, "c1"), (1, "c2"), (0, "c3")):
        activity.answered(Event(f"done.command.{id}", None, 1.0))
        assert activity.commands == left
