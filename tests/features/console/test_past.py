"""Days, entries, why and files, of an exhibition with visitors."""

import asyncio
from contextlib import closing
from datetime import date
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from lumen.features.console.known_robot import KnownRobot
from lumen.features.console.past import Past
from lumen.features.console.requests import DeniedError
from lumen.features.console.sentences import Sentences
from lumen.lint import check_files
from lumen.project.files import read_files
from tests.features.console.conftest import Hosted, Shared
from tests.features.console.pages import Browser, Served, Stream
from tests.tables import for_each
from tests.waiting import until


@pytest.fixture(scope="module")
def browser(shared: Shared) -> Browser:
    """A console after a visit whose visitor had a script as a name, and said a spreadsheet formula."""
    hosted, browser = shared.hosted(), shared.served().browser
    position = browser.robots[0]["position"]
    hosted.send("face", {"x": 160, "y": 120})
    until(lambda: "greet" in hosted.exhibition.configuration)
    hosted.send("heard", {"result": "<script>alert(1)</script>", "language": "en"})
    hosted.send("heard", {"result": "=1+1", "language": "en"})
    until(lambda: (browser.robots[0]["position"] or 0) > position + 2)
    return browser


def test_a_day_has_its_visits_and_numbers(browser: Browser) -> None:
    until(lambda: len(browser.get("/api/day").data["numbers"]["asked"]) == 2)
    day = browser.get("/api/day").data
    assert day["date"] in day["dates"]
    [visit] = day["visits"]
    assert visit["n"] == 1
    assert day["numbers"]["visits"] == 1
    assert dict(day["numbers"]["asked"]) == {"<script>alert(1)</script>": 1, "=1+1": 1}
    assert day["numbers"]["answers"]
    entries = browser.get(f"/api/entries?from={visit['from']}&to={visit['to']}").data["entries"]
    assert [entry["position"] for entry in entries] == list(range(visit["from"], visit["to"] + 1))
    assert all(entry["at_time"].startswith(day["date"][:4]) for entry in entries)
    path = f"/api/search?from={visit['from']}&to={visit['to']}&text="
    found = browser.get(f"{path}SCRIPT%3E").data
    assert [entry["data"]["result"] for entry in found["entries"]] == ["<script>alert(1)</script>"]
    assert not found["more"]
    assert browser.get(f"{path}nothing%20of%20it").data["entries"] == []
    assert browser.get(path).status == 400
    answer = browser.get("/api/day.csv")
    assert answer.headers["content-type"].startswith("text/csv")
    assert "asked,'=1+1,1" in answer.body.decode()


def test_a_question_becomes_a_passage_of_the_project(copy: Path) -> None:
    with closing(Hosted(copy)), closing(Served(copy)) as served:
        until(lambda: any(robot["connected"] for robot in served.browser.robots))
        passage = {"question": "what is love", "answer": "A question.", "language": "en"}
        assert served.browser.post("/api/passages", passage).data == {"file": "knowledge/what-is-love.yaml"}
        assert "what is love" in (copy / "knowledge" / "what-is-love.yaml").read_text("utf-8")
        refused = served.browser.post("/api/passages", {**passage, "answer": ""})
        assert (refused.status, "`answer`" in refused.data["reason"]) == (400, True)
        assert served.browser.get("/api/day").data["numbers"]["unanswered"] == []


@for_each("path", ["chart", "skills", "passages", "sayings", "stories", "sentence"])
def test_files_of_a_robot_on_another_machine_are_neither_read_nor_written(path: str, tmp_path: Path) -> None:
    posted = {"question": "what is love", "answer": "A question.", "language": "en", "position": 1, "write": True}

    async def data(request: Any) -> dict[str, Any]:
        return posted

    keys = SimpleNamespace(is_ours=lambda robot: robot != "NAO7")
    here = {"watch": SimpleNamespace(keys=keys), "person": lambda *_: None, "posted": data}
    reception: Any = SimpleNamespace(**here, robot=lambda name: KnownRobot("NAO7"))
    jobs: Any = SimpleNamespace(root=tmp_path)
    past = Past(reception, jobs)
    for route in (*past.routes, *Sentences(reception, jobs, past).routes):
        if route.path == f"/api/{path}":
            with pytest.raises(DeniedError, match="this robot's files are on another machine"):
                asyncio.run(route.endpoint(SimpleNamespace(query_params={})))
    assert list(tmp_path.iterdir()) == []


def test_a_visit_becomes_a_story_without_the_name(copy: Path) -> None:
    with closing(Hosted(copy)) as hosted, closing(Served(copy)) as served:
        hosted.send("face", {"x": 160, "y": 120})
        until(lambda: "ask_name" in hosted.exhibition.configuration)
        hosted.send("heard", {"result": "my name is Budi", "language": "en"})
        until(lambda: hosted.exhibition.context["visitor"] == "Budi")
        until(lambda: served.browser.get("/api/day").data["visits"])
        [visit] = served.browser.get("/api/day").data["visits"]
        story = {"position": visit["from"], "visitor": "Budi", "name": "Ani"}
        kept = served.browser.post("/api/stories", story).data
        text = (copy / kept["file"]).read_text("utf-8")
        assert kept["file"].startswith("behaviors/stories/visit_")
        assert "Ani" in text
        assert "Budi" not in text
        assert [str(one) for one in check_files(copy, read_files(copy))[1] if one.place.file == kept["file"]] == []
        assert served.browser.post("/api/stories", story).data["file"] != kept["file"]
        for wrong in ({**story, "name": " "}, {**story, "position": "1"}, {**story, "position": 10**9}):
            refused = served.browser.post("/api/stories", wrong)
            assert (refused.status, list(refused.data)) == (400, ["reason"])


def test_a_passage_in_all_languages_makes_no_warning(copy: Path) -> None:
    with closing(Hosted(copy)), closing(Served(copy)) as served:
        until(lambda: any(robot["connected"] for robot in served.browser.robots))
        also = {"id": {"question": "apa itu cinta", "answer": "Pertanyaan."}}
        passage = {"question": "what is love", "answer": "A question.", "language": "en", "also": also}
        assert served.browser.post("/api/passages", passage).data == {"file": "knowledge/what-is-love.yaml"}
        text = (copy / "knowledge" / "what-is-love.yaml").read_text("utf-8")
        assert "apa itu cinta" in text
        findings = check_files(copy, read_files(copy))[1]
        assert [str(one) for one in findings if one.place.file == "knowledge/what-is-love.yaml"] == []
        half = {**passage, "also": {"id": {"question": "apa itu cinta"}}}
        assert "`answer`" in served.browser.post("/api/passages", half).data["reason"]
        wrong = served.browser.post("/api/passages", {**passage, "also": ["id"]})
        assert (wrong.status, "`also` must be an object" in wrong.data["reason"]) == (400, True)


def test_the_day_is_there_without_the_exhibition(copy: Path) -> None:
    """After a crash it is needed most: visits, entries and why are read from the journal on the disk."""
    with closing(Hosted(copy)) as hosted:
        hosted.send("face", {"x": 160, "y": 120})
        until(lambda: "greet" in hosted.exhibition.configuration)
        hosted.send("heard", {"result": "what is love", "language": "en"})
        with closing(Served(copy)) as served:
            until(lambda: served.browser.get("/api/day").data["numbers"]["asked"])
            before = served.browser.get("/api/day").data["visits"][0]
            path = f"/api/entries?from={before['from']}&to={before['to']}"
            told = served.browser.get(path).data["entries"]
    with closing(Served(copy)) as served:  # another console, which has never reached it
        [robot] = served.browser.robots
        assert (robot["robot"], robot["connected"]) == ("NAO", False)
        [visit] = served.browser.get("/api/day").data["visits"]
        assert (visit["from"], visit["began"]) == (before["from"], before["began"])
        assert served.browser.get(path).data["entries"] == told
        why = served.browser.get("/api/why?what=greet").data
        assert "chain" in why, why
        assert served.browser.get("/api/day.csv").status == 200


def test_what_happens_between_visits_has_its_place_in_the_day(copy: Path) -> None:
    with closing(Hosted(copy)) as hosted, closing(Served(copy)) as served:
        until(lambda: any(robot["connected"] for robot in served.browser.robots))
        _told_between(served.browser, hosted)


def _told_between(browser: Browser, hosted: Hosted) -> None:
    hosted.send("heard", {"result": "is anybody there", "language": "en"})

    def told() -> list[str]:
        between = browser.get("/api/day").data["between"]
        pages = [browser.get(f"/api/entries?from={one['from']}&to={one['to']}").data["entries"] for one in between]
        return [entry["text"] for page in pages for entry in page]

    until(lambda: any("is anybody there" in text for text in told()))
    day = browser.get("/api/day").data
    assert day["visits"] == []
    assert day["between"][0]["began"] <= day["between"][-1]["ended"]


def test_an_entry_has_one_time_whenever_it_is_asked_for(browser: Browser) -> None:
    with Stream(browser, "/api/events?after=-1") as stream:
        until(lambda: len(stream.of("entry")) > 3)
    live = {event.data["position"]: event.data["at_time"] for event in stream.of("entry")}
    for first in (0, max(live) - 1):
        told = browser.get(f"/api/entries?from={first}&to={max(live)}").data["entries"]
        assert {one["position"]: one["at_time"] for one in told} == {at: live[at] for at in live if at >= first}
    [visit] = browser.get("/api/day").data["visits"]
    assert live[visit["from"]][:-5] == visit["began"][:19]


def test_what_is_asked_wrongly_is_said(browser: Browser) -> None:
    for path in ("/api/day?date=yesterday", "/api/entries?from=a&to=2", "/api/entries"):
        assert (browser.get(path).status, list(browser.get(path).data)) == (400, ["reason"])
    assert browser.get("/api/day?robot=NAO7").status == 404
    assert browser.get("/api/day?date=1999-01-01").data["visits"] == []
    assert date.fromisoformat(browser.get("/api/day").data["date"])


def test_it_says_why_and_why_not(browser: Browser) -> None:
    why = browser.get("/api/why?what=greet").data
    assert why["chain"][0]["text"]
    assert browser.get("/api/why-not?what=dance").data["reasons"]
    assert browser.get("/api/why?what=moonwalk").status == 404


def test_files_are_as_the_exhibition_says(browser: Browser) -> None:
    until(lambda: browser.robots[0]["files"])
    assert browser.get("/api/files").data["mode"] == "manual"


def test_the_robot_is_drawn_from_its_own_model(browser: Browser) -> None:
    shape = browser.get("/api/shape").data
    assert any(link["name"] == "Head" or "Head" in link["name"] for link in shape["links"])
    assert shape["stage"]["x"] == [-0.4, 0.4]


def test_who_marked_and_who_spoke_is_in_the_journal(browser: Browser) -> None:
    browser.command("mark", text="he waved")
    browser.command("say", text="Welcome back")
    until(lambda: "says “Welcome back”, by author" in texts(browser))
    assert "mark: he waved, by author" in texts(browser)
    [mark] = browser.get("/api/day").data["marks"]
    assert (mark["text"], mark["by"]) == ("he waved", "author")


def texts(browser: Browser) -> list[str]:
    position = browser.robots[0]["position"] or 0
    return [entry["text"] for entry in browser.get(f"/api/entries?from=0&to={position}").data["entries"]]
