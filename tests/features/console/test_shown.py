"""The pages of the day, the files and the hall show whole texts and the present state."""

import re
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import pytest
from selenium.webdriver.common.keys import Keys

from tests.features.console.conftest import Hosted
from tests.features.console.pages import Served
from tests.features.console.test_conversation import violations
from tests.features.console.viewer import Viewer
from tests.live.conftest import wait_for_visitors
from tests.saving import save
from tests.waiting import HANG, until

pytestmark = pytest.mark.slow
SORRY = 'en: "I am sorry, I cannot wave right now. Goodbye!"'
LATER = 'en: "I am sorry, I cannot wave right now. See you tomorrow, perhaps!"'
LOVE = "questions: {en: [what is love], id: [apa itu cinta]}\nanswer: {en: A question., id: Pertanyaan.}\n"
NO_POSE = """
delete globalThis.SharedWorker;
const before = globalThis.fetch;
globalThis.fetch = (path, ...more) => {
  const waits = `${path}`.startsWith("/api/poses") && !globalThis.posing;
  return waits ? new Promise((_, fail) => { globalThis.end = fail; }) : before(path, ...more);
};
"""
"""Holds each request for poses until `posing` is set."""
ASKED = """
const get = Response.prototype.json;
Response.prototype.json = async function () {
  const said = await get.call(this);
  const asked = [{ text: "what is the meaning of life", language: "en", count: 2 }];
  return said.numbers ? { ...said, numbers: { ...said.numbers, unanswered: asked } } : said;
};
"""
"""Adds an unanswered question to the numbers of the day."""
DRAWN = "return document.querySelector('canvas')?.scene?.robot.visible"


@pytest.fixture
def own(copy: Path) -> Iterator[tuple[Hosted, Served]]:
    """An exhibition that a test may edit, with patience for its visitors, and its console."""
    wait_for_visitors(copy, "30s", "2h")
    with closing(Hosted(copy)) as hosted, closing(Served(copy)) as served:
        until(lambda: [robot["connected"] for robot in served.browser.robots] == [True], HANG)
        yield hosted, served


def visit(hosted: Hosted, name: str) -> None:
    hosted.send("face", {"x": 160, "y": 120})
    until(lambda: "ask_name" in hosted.exhibition.configuration, HANG)
    hosted.send("heard", {"result": f"my name is {name}", "language": "en"})
    until(lambda: hosted.exhibition.context["visitor"] == name, HANG)


def test_a_visit_that_begins_is_in_the_day_that_is_shown(viewer: Viewer, own: tuple[Hosted, Served]) -> None:
    hosted, served = own
    viewer.open(served.console.address, "robot/NAO/day", ready=".day")
    assert viewer.all(".visit-list li") == []
    visit(hosted, "Budi")
    viewer.shows("Budi", ".visit-list li")
    assert len(viewer.all(".line .bar")) == 1


def test_a_moment_is_found_by_its_time_and_by_words(viewer: Viewer, own: tuple[Hosted, Served]) -> None:
    hosted, served = own
    visit(hosted, "Budi")
    viewer.open(served.console.address, "robot/NAO/day", ready=".find")
    viewer.shows("1\nvisit", ".totals")
    viewer.click(".search input")
    viewer.type("NAME IS BUDI", Keys.ENTER)
    viewer.shows("my name is Budi", ".found li")
    found = viewer.run("return document.querySelector('.found time').getAttribute('datetime')")
    viewer.click(".found button")
    viewer.shows("my name is Budi", ".chosen")
    viewer.click(".search input")
    viewer.type(" and more", Keys.ENTER)
    viewer.shows("0 found", ".find")
    viewer.click(".go-to input")
    viewer.type("25:00", Keys.ENTER)
    viewer.shows("write it as 14:03", ".find")
    local = viewer.run("return new Date(arguments[0]).toLocaleTimeString('en-GB')", found)
    viewer.run("document.querySelector('.go-to input').select()")
    viewer.type(local, Keys.ENTER)
    viewer.shows(f"At {local}", ".day .entries")
    viewer.run("document.querySelector('.go-to input').select()")
    viewer.type(local[:-3], Keys.ENTER)  # the visit begins after the full minute
    viewer.shows("my name is Budi", ".day .entries")
    assert violations(viewer) == []


def test_regions_in_which_nothing_has_changed_are_folded(viewer: Viewer, served: Served) -> None:
    viewer.open(served.console.address, "robot/NAO", ready=".still")
    before = viewer.text(".still summary")
    names = before.removeprefix("Nothing has changed in:").strip().split(", ")
    assert names
    assert len(names) < len(viewer.run("return [...document.querySelectorAll('.leaf')].map((e) => e.textContent)"))
    viewer.click(".still summary")
    viewer.shows(names[0], ".still .boxes")


def test_the_chart_is_drawn_with_the_active_states(viewer: Viewer, own: tuple[Hosted, Served]) -> None:
    hosted, served = own
    viewer.open(served.console.address, "robot/NAO", ready=".chart-open")
    viewer.click(".chart-open")
    until(lambda: viewer.all(".state-chart rect"), HANG)
    active = "return [...document.querySelectorAll('.chart-state[data-leaf][data-active]')].map((e) => e.dataset.path)"
    leaves = "return [...document.querySelectorAll('.leaf .state-name')].map((e) => e.textContent)"
    until(lambda: len(viewer.run(active)) == len(viewer.run(leaves)), HANG)
    visit(hosted, "Budi")
    until(lambda: any(path.endswith("how_are_you") for path in viewer.run(active)), HANG)
    assert viewer.all(".chart-state[data-been]:not([data-active])")
    assert violations(viewer) == []
    assert viewer.complaints() == []


def situated(viewer: Viewer, words: str) -> None:
    """Wait until the situation has these words, and then how long it has lasted."""
    viewer.until(lambda: re.search(rf"{words}[\d:]*\d:\d\d", viewer.text(".situation")))


def test_the_page_begins_with_the_situation_in_a_sentence(viewer: Viewer, own: tuple[Hosted, Served]) -> None:
    """It names the action, the visitor, the duration and the remaining time; then the words, and how sure the ears
    were.
    """
    hosted, served = own
    viewer.open(served.console.address, "robot/NAO", ready=".leaf")
    situated(viewer, "Waits, ")
    visit(hosted, "Budi")
    hosted.send("heard", {"result": "blue cheese", "language": "en", "confidence": 0.41})
    viewer.shows("blue cheese (the ears are 41% sure)", ".talk-lines")
    situated(viewer, "for Budi, ")
    height = "return document.querySelector('.declared').getBoundingClientRect().top"
    before = viewer.run(height)
    served.browser.command("goto", state="dance")
    situated(viewer, "Plays dance for Budi, ")
    viewer.shows(" s left", ".situation")
    viewer.shows("Robot: With pleasure!", ".talk-lines")
    assert viewer.run(height) == before
    assert len(viewer.all(".talk-lines li")) <= 10


def test_the_day_is_shown_after_a_crash(viewer: Viewer, copy: Path) -> None:
    with closing(Hosted(copy)) as hosted:
        visit(hosted, "Budi")
    with closing(Served(copy)) as served:
        viewer.open(served.console.address, "robot/NAO/day", ready=".visit-list")
        viewer.shows("Budi", ".visit-list li")
        viewer.run("document.querySelector('.day .entries').scrollIntoView()")  # what is not seen is not laid out
        viewer.shows("my name is Budi", ".day .entry-list")
        viewer.shows("the robot does not answer", ".connection")


def test_a_changed_text_is_shown_before_and_after_with_its_line(viewer: Viewer, own: tuple[Hosted, Served]) -> None:
    hosted, served = own
    tour = hosted.root / "behaviors" / "tour.yaml"
    text = tour.read_text("utf-8")
    line = text[: text.index(SORRY)].count("\n") + 1
    viewer.open(served.console.address, "robot/NAO/files", ready=".saved", mode="author")
    save(tour, text.replace(SORRY, LATER))
    viewer.shows("See you tomorrow, perhaps", ".changes ins")
    viewer.shows("Goodbye", ".changes del")
    places = viewer.text(".changes .place")
    assert places.startswith("behaviors/tour.yaml:")
    assert abs(int(places.rpartition(":")[2]) - line) <= 1  # of the `say` that the text is in
    assert "− I am sorry, I cannot wave right now." in viewer.text(".changes")


def test_a_roll_back_restores_the_file_and_names_the_newer_one(viewer: Viewer, own: tuple[Hosted, Served]) -> None:
    hosted, served = own
    tour = hosted.root / "behaviors" / "tour.yaml"
    text = tour.read_text("utf-8")
    viewer.open(served.console.address, "robot/NAO/files", ready=".saved", mode="author")
    save(tour, text.replace(SORRY, LATER))
    viewer.shows("See you tomorrow, perhaps", ".changes ins")
    viewer.click(".saved [data-verb=apply]")
    viewer.click("dialog .strong")
    viewer.shows("active", ".saved .badge")
    until(lambda: LATER in tour.read_text("utf-8") and hosted.exhibition.project.hash, HANG)
    viewer.click(".saved [data-verb=rollback]")
    viewer.click("dialog .strong")
    viewer.shows("behaviors/tour.yaml is as it was before; the newer version is in .lumen/rolled-back/", ".saved")
    assert tour.read_text("utf-8") == text
    save(hosted.root / "knowledge" / "love.yaml", LOVE)
    viewer.shows("love", ".changes")
    assert "See you tomorrow" not in viewer.text(".changes")


def test_files_that_are_tried_are_kept_during_the_visit(viewer: Viewer, own: tuple[Hosted, Served]) -> None:
    hosted, served = own
    tour = hosted.root / "behaviors" / "tour.yaml"
    viewer.open(served.console.address, "robot/NAO/files", ready=".saved", mode="author")
    save(tour, tour.read_text("utf-8").replace(SORRY, LATER))
    viewer.shows("See you tomorrow, perhaps", ".changes ins")
    viewer.click(".saved [data-verb=try]")
    viewer.shows("These files are tried for one visitor", ".file-actions")
    viewer.click(".saved [data-verb=apply]")
    viewer.shows("Keep the files that are tried?", "dialog")
    viewer.click("dialog .strong")
    viewer.shows("stay active", ".saved")
    viewer.shows("Nothing waits", ".file-actions")


def test_a_robot_is_drawn_only_once_its_pose_is_known(served: Served, hosted: Hosted) -> None:
    names = list(hosted.exhibition.project.body.joints)
    joints = {"name": names, "angle": [0.0] * len(names), "stiffness": [1.0] * len(names)}

    def drawn() -> bool:
        hosted.exhibition.node.bus.publish("avatar.NAO.data.joint", joints)
        return bool(viewer.run(DRAWN))

    with closing(Viewer(first=NO_POSE)) as viewer:
        viewer.open(served.console.address, "robot/NAO/see", ready="canvas", see="hall")
        until(lambda: viewer.run(DRAWN) is not None, HANG)
        viewer.shows("Waiting for the first pose", ".hall")
        assert not drawn()
        viewer.run("globalThis.posing = true; globalThis.end(new Error('again'))")
        until(drawn, HANG)


def test_a_phone_on_its_side_has_rest_beside_the_settings(viewer: Viewer, served: Served) -> None:
    for language in ("en", "id"):
        viewer.open(served.console.address, "robot/NAO", ready=".leaf", language=language)
        viewer.size(844, 390)
        hit = """
        const box = document.querySelector(".settings > button").getBoundingClientRect();
        return [0.05, 0.5, 0.95].map((part) => Boolean(document.elementFromPoint(
          box.left + part * box.width, box.top + box.height / 2)?.closest(".settings")));
        """
        assert viewer.run(hit) == [True, True, True], language
    viewer.size(1400)


def test_the_menu_closes_on_escape_and_gives_the_focus_back(viewer: Viewer, served: Served) -> None:
    viewer.open(served.console.address, "robot/NAO", ready=".leaf")
    viewer.click(".settings > button")
    until(lambda: viewer.text("#settings"), HANG)
    viewer.type(Keys.ESCAPE)
    until(lambda: not viewer.text("#settings"), HANG)
    assert viewer.run("return document.activeElement.matches('.settings > button')")
    assert viewer.text(".rest-said") == ""


def test_an_answer_is_asked_for_in_all_languages_of_the_project(own: tuple[Hosted, Served]) -> None:
    hosted, served = own
    with closing(Viewer(first=ASKED)) as viewer:
        viewer.open(served.console.address, "robot/NAO/day", ready=".unanswered li button", mode="author")
        viewer.click(".unanswered li button")
        labels = viewer.text(".unanswered form label").splitlines()
        assert labels == ["Answer (English)", "Question (Indonesian)", "Answer (Indonesian)"]
        for field, words in enumerate(("Forty-two.", "apa arti hidup", "Empat puluh dua."), 1):
            viewer.click(f".unanswered form label:nth-of-type({field}) input")
            viewer.type(words)
        viewer.click(".unanswered form button")
        viewer.shows("saved as knowledge/what-is-the-meaning-of-life.yaml", ".unanswered")
    text = (hosted.root / "knowledge" / "what-is-the-meaning-of-life.yaml").read_text("utf-8")
    assert all(words in text for words in ("Forty-two.", "apa arti hidup", "Empat puluh dua."))


def test_an_operator_reads_sentences_and_an_author_all_transitions(viewer: Viewer, own: tuple[Hosted, Served]) -> None:
    """Operators see no guard, path or data on Now and in a why; an author sees all of it."""
    hosted, served = own
    visit(hosted, "Budi")
    viewer.open(served.console.address, "robot/NAO", ready=".leaf", mode="operator")
    viewer.shows("You press “End the visit”: the robot goes on to “goodbye”", ".next")
    assert "context." not in viewer.text(".ways") + viewer.text(".states")
    viewer.click(".entry button")
    until(lambda: viewer.all(".chain .link"), HANG)
    for selector in ("main", "dialog"):
        shown = viewer.text(selector)
        assert [sign for sign in (".yaml", "context.", "event.data", '{"', "lumen.NAO") if sign in shown] == []
    viewer.open(served.console.address, "robot/NAO", ready=".leaf", mode="author")
    viewer.click(".all-ways summary")
    viewer.shows("behaviors/tour.yaml:", ".ways")


def test_files_tell_an_author_what_buttons_do_and_in_any_mode_what_changed(
    viewer: Viewer, own: tuple[Hosted, Served]
) -> None:
    hosted, served = own
    tour = hosted.root / "behaviors" / "tour.yaml"
    viewer.open(served.console.address, "robot/NAO/files", ready=".saved", mode="author")
    assert "Nothing waits" in viewer.text(".file-actions")
    save(tour, tour.read_text("utf-8").replace(SORRY, LATER))
    viewer.shows("Makes the saved files active", ".file-actions")
    viewer.open(served.console.address, "robot/NAO/files", ready=".saved", mode="operator")
    viewer.shows("See you tomorrow, perhaps", ".changes ins")
    assert not viewer.all(".file-actions")
