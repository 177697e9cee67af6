"""`lumen why` and `lumen why-not` explain an exhibition in Python, a running one, or a journal."""

import json
import time
from collections.abc import Iterator
from datetime import datetime, timedelta, timezone
from pathlib import Path
from typing import Any

import pytest

import lumen
from lumen.cli.answers import why_lines, why_not_lines
from lumen.cli.main import main
from lumen.cli.questions import moment
from lumen.errors import UsageError
from lumen.journal.journal_writer import JournalWriter
from lumen.language.people import PersonName
from lumen.run.answering import reply
from lumen.run.exhibition import Exhibition
from tests.tables import for_each

LINK = {"kind", "text", "at", "file", "line", "id", "values"}
NOWHERE = JournalWriter(None)
REASON = {"because", "text", "file", "line", "false", "change", "note"}


@pytest.fixture(scope="module")
def greeted() -> Iterator[Exhibition]:
    """An exhibition that greeted a visitor, asked for the name, and did not understand the answer."""
    with lumen.open() as exhibition:
        exhibition.send("face", {"x": 160, "y": 120})
        exhibition.run(12.0)
        exhibition.send("heard", {"result": "?"})
        exhibition.run(0.2)
        yield exhibition


def kinds(answer: dict[str, Any]) -> list[str]:
    return [link["kind"] for link in answer["chain"]]


def test_a_text_leads_back_to_the_message(greeted: Exhibition) -> None:
    answer = greeted.why("not hear your name")
    assert set(answer) == {"what", "at", "chain", "needs"}
    assert all(set(link) == LINK for link in (*answer["chain"], *answer["needs"]))
    assert [link["text"].partition(":")[0] for link in answer["needs"]] == [
        "entered waiting, ask_name, face.watched, face.watched.armed",
        "entered talking, greet",
    ]
    assert kinds(answer) == ["command", "activity", "transition", "event", "message"]
    command, _, transition, event, message = answer["chain"]
    assert command["file"] == transition["file"] == "behaviors/tour.yaml"
    lines = Path("behaviors/tour.yaml").read_text("utf-8").splitlines()
    assert "say" in lines[command["line"] - 1]
    assert "context.name_tries < 2" in lines[transition["line"] - 1]
    assert transition["values"] == {"context.name_tries": 0}
    assert event["values"]["event.data.result"] == "?"
    assert ".audio.speech.recognition" in message["text"]


def test_an_answer_leads_on_to_the_command_and_that_to_the_face(greeted: Exhibition) -> None:
    answer = greeted.why("I am Lumen")
    found = ["command", "activity", "event", "command", "activity", "transition", "event", "message"]
    assert kinds(answer) == found
    assert answer["chain"][2]["id"] == answer["chain"][3]["id"]
    assert answer["chain"][-2]["text"].startswith("face")


def test_a_state_and_nothing_at_all(greeted: Exhibition) -> None:
    assert kinds(greeted.why("talking"))[0] == "transition"
    assert greeted.why("idle")["chain"][-1]["kind"] == "start"
    assert greeted.why()["chain"][0]["text"].startswith("says")


def test_what_a_visitor_could_have_said(greeted: Exhibition) -> None:
    answer = greeted.why_not("check_name")
    assert all(set(reason) == REASON for reason in answer["reasons"])
    first = answer["reasons"][0]
    assert first["because"] == "unheard"
    assert first["false"] == {"text": "hears my_name", "values": {"event.data.result": "?"}}
    assert first["change"]["event.data.result"].endswith("Budi")
    dance = greeted.why_not("dance")["reasons"][0]
    assert (dance["because"], dance["change"]["state"]) == ("inactive", "guide.talking.waiting.wishes")
    assert dance["change"]["event.data.result"] == "dance"
    said, pressed, gone, waits = greeted.why_not("goodbye")["reasons"][:4]
    assert (said["because"], said["change"]) == ("unheard", {"event.data.result": "bye"})
    assert (pressed["because"], pressed["change"]) == ("no-event", {"event": "operator.end"})
    assert (gone["because"], gone["change"]) == ("no-event", {"event": "visitor.left"})
    assert (waits["because"], set(waits["change"])) == ("no-event", {"wait"})


@for_each(
    ("question", "what", "said"),
    [
        ("why", "dnace", "did you mean `dance`?"),
        ("why", "dance", "run `lumen why-not dance`"),
        ("why-not", "dnace", "did you mean `dance`?"),
        ("why-not", "talking", "run `lumen why talking`"),
        ("why-not", "", "name a state, a motion or a text"),
    ],
)
def test_a_question_without_an_answer_says_what_to_do(greeted: Exhibition, question: str, what: str, said: str) -> None:
    answer = reply(greeted.history(), {"ask": question, "what": what}, NOWHERE)
    assert answer["verdict"] == "refused"
    assert said in answer["reason"]


def test_what_is_no_question_is_refused(greeted: Exhibition) -> None:
    for body in ({"at": "soon"}, {"at": "1970-01-01T00:00:00Z"}, {"what": "x" * 10_000}):
        assert reply(greeted.history(), {"ask": "why", **body}, NOWHERE)["verdict"] == "refused"


def test_it_reads_well(greeted: Exhibition) -> None:
    told = [*why_lines(greeted.why("not hear your name")), *why_not_lines(greeted.why_not("check_name"))]
    assert all(len(line) <= 100 for line in told)
    text = "\n".join(told)
    assert "because ask_name → ask_name, hears else, as context.name_tries < 2" in text
    assert "context.name_tries is 0" in text
    assert "it would have happened if event.data.result had been " in text


def test_letters_with_marks_are_shown_as_they_are() -> None:
    change = {"event": "heard", "event.data.result": "Grüß Gott"}
    false = {"values": {"context.name": "José"}}
    reason = {"text": "hello → met", "because": "guard", "false": false, "change": change, "note": "", "file": ""}
    answer = {"what": "met", "reasons": [reason], "at": "2015-05-20T10:00:00+00:00"}
    told = "\n".join(why_not_lines(answer))
    assert 'if heard had come with event.data.result "Grüß Gott"' in told
    assert 'context.name is "José"' in told


@pytest.mark.process
@pytest.mark.slow
def test_who_runs_is_asked_and_who_does_not_has_a_journal(
    exhibition: Exhibition, copy: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["why", "idle", str(copy), "--format", "json"]) == 0
    assert json.loads(capsys.readouterr().out)["chain"][-1]["kind"] == "start"
    assert main(["why-not", "dance", str(copy)]) == 0
    assert "its state was not active" in capsys.readouterr().out
    assert main(["why-not", "idle", str(copy)]) == 1
    assert "run `lumen why idle`" in capsys.readouterr().err


@pytest.mark.slow
def test_a_run_that_is_over_is_asked_by_its_journal(copy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["why", "idle", str(copy)]) == 1
    assert "start it with `lumen run`" in capsys.readouterr().err
    with lumen.open(copy) as exhibition:
        exhibition.send("face", {"x": 160, "y": 120})
        exhibition.run(3.0)
        asked = exhibition.why("greet")
    assert main(["why", "greet", str(copy), "--format", "json"]) == 0
    assert json.loads(capsys.readouterr().out) == asked == lumen.why("greet", str(copy))


@pytest.mark.slow
def test_a_story_is_asked_at_its_own_time(copy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with lumen.open(copy, story="shy") as exhibition:
        exhibition.run()
        last = exhibition.why()["at"]
    greeted = datetime.fromisoformat(lumen.why("greet", str(copy))["at"]).astimezone()
    assert main(["why", "greet", str(copy), "--at", f"{greeted:%H:%M:%S}", "--format", "json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert datetime.fromisoformat(answer["at"]) == greeted
    assert answer["at"] < last


@pytest.mark.slow
def test_who_is_forgotten_is_in_no_answer(copy: Path) -> None:
    with lumen.open(copy) as exhibition:
        exhibition.send("recognised", {"name": "Budi"})
        exhibition.run(0.1)
        assert "Budi" in str(exhibition.history())
        exhibition.behavior.forget(PersonName("Budi"))
        exhibition.run(0.1)
        assert "Budi" not in str(exhibition.history())


def test_a_time_of_day_is_the_last_one() -> None:
    here = timezone(timedelta(hours=7))
    now = datetime(2026, 11, 22, 14, 0, tzinfo=here)
    assert moment("13:59", now) == "2026-11-22T06:59:59.999000+00:00"
    assert moment("14:03:20", now) == "2026-11-21T07:03:20.999000+00:00"
    assert moment("2026-11-20T12:00:00+07:00", now) == "2026-11-20T05:00:00+00:00"
    with pytest.raises(UsageError, match=r"write 14:03"):
        moment("soon", now)


@pytest.mark.parametrize(
    ("now", "text", "meant"),
    [
        ((2026, 10, 25, 10), "22:00", "2026-10-24T20:00:59.999000+00:00"),
        ((2026, 10, 25, 10), "01:30", "2026-10-24T23:30:59.999000+00:00"),
        ((2027, 3, 28, 10), "22:00", "2027-03-27T21:00:59.999000+00:00"),
        ((2027, 3, 28, 10), "01:30", "2027-03-28T00:30:59.999000+00:00"),
    ],
)
def test_a_time_of_day_before_summer_time_changed_is_that_of_then(
    now: tuple[int, int, int, int], text: str, meant: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    with monkeypatch.context() as here:
        here.setenv("TZ", "Europe/Berlin")
        time.tzset()
        assert moment(text, datetime(*now)) == meant
    time.tzset()
