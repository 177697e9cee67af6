"""The pages of a running exhibition in Chromium: they load, rest the robot, and show an alarm if they can't."""

import socket
from collections.abc import Iterator
from contextlib import ExitStack, closing

import pytest
from selenium.webdriver.common.keys import Keys

from lumen.run import forking
from tests.features.console.conftest import Hosted
from tests.features.console.pages import Served
from tests.features.console.test_conversation import violations
from tests.features.console.viewer import Viewer
from tests.fetched import fetched
from tests.waiting import HANG, until

pytestmark = pytest.mark.slow
PAGES = {
    "now": ("robot/NAO", ".leaf"),
    "day": ("robot/NAO/day", ".totals"),
    "files": ("robot/NAO/files", ".saved"),
    "see": ("robot/NAO/see", ".picture"),
    "subtitles": ("robot/NAO/subtitles", ".subtitles"),
}
"""The path of each page, and a selector that matches once it is drawn."""
OPERATORS = ("now", "day", "files", "see")
NARROW = 360
ESCAPE = """
dispatchEvent(new KeyboardEvent("keydown", { key: "Escape" }));
return document.querySelector("rest-button[main] .rest-said").innerText;
"""
INSTEAD = """
const select = document.querySelector(".fork select.instead");
select.value = arguments[0];
select.dispatchEvent(new Event("change", { bubbles: true }));
"""
HELD = """
for (const [name, timeStamp] of [["keydown", 0], ["keyup", arguments[0]]]) {
  const event = new KeyboardEvent(name, { key: "Enter", bubbles: true });
  document.querySelector(".declared").dispatchEvent(Object.defineProperty(event, "timeStamp", { value: timeStamp }));
}
"""
"""Holds a button for so long [ms] on a page that hears both events only then."""
TOUCH = 44
"""Smallest width and height of a control for fingers [px]."""


@pytest.fixture(scope="module")
def overhearing() -> Iterator[Viewer]:
    one = Viewer(overhearing=True)
    yield one
    one.close()


def rests(hosted: Hosted) -> bool:
    return hosted.exhibition.robot.server.hold.stopped


@pytest.mark.parametrize("page", PAGES)
def test_a_page_loads_from_here_alone_and_complains_of_nothing(overhearing: Viewer, served: Served, page: str) -> None:
    viewer, (path, ready) = overhearing, PAGES[page]
    viewer.open(served.console.address, path, ready=ready)
    asked = viewer.requests()
    assert any(url.endswith("/pages/rest.js") for url in asked)
    assert [url for url in asked if not url.startswith((served.console.address, "data:", "about:", "chrome"))] == []
    assert viewer.complaints() == []


@pytest.mark.parametrize("page", OPERATORS)
def test_rest_rests_the_robot_and_says_so(viewer: Viewer, served: Served, hosted: Hosted, page: str) -> None:
    path, ready = PAGES[page]
    viewer.open(served.console.address, path, ready=ready)
    viewer.click("rest-button[main] .rest")
    viewer.shows("Rests", ".rest-said")
    assert rests(hosted)


def test_escape_twice_is_the_same_and_once_is_not(viewer: Viewer, served: Served, hosted: Hosted) -> None:
    viewer.open(served.console.address, ready=".leaf")
    assert "Escape once more" in viewer.run(ESCAPE)  # within one script: the hint is gone after a moment
    until(lambda: not viewer.text(".rest-said"), HANG)
    assert not rests(hosted)
    viewer.escape_twice()
    viewer.shows("Rests", ".rest-said")
    assert rests(hosted)


def test_resume_asks_first_and_leaves_rest_in_reach(viewer: Viewer, served: Served, hosted: Hosted) -> None:
    viewer.open(served.console.address, ready=".leaf")
    viewer.click(".rest")
    viewer.click(".resume")
    viewer.shows("is there room around the robot", "dialog")
    assert rests(hosted)
    viewer.click("rest-button[main] .rest")  # selenium refuses to click what something else covers
    viewer.click("dialog .strong")
    until(lambda: not rests(hosted), HANG)
    until(lambda: not viewer.all(".stopped"), HANG)


def test_rest_that_is_not_sent_says_so_until_somebody_closes_it(viewer: Viewer, served: Served) -> None:
    viewer.open(served.console.address, ready=".leaf")
    served.close()
    viewer.click(".rest")
    viewer.shows("NOT SENT", ".rest-said [role=alert]")
    viewer.shows("console does not answer", ".connection")
    viewer.click(".rest-said button")
    assert viewer.text(".rest-said") == ""


def test_a_server_that_is_silent_is_not_one_that_was_reached(viewer: Viewer, served: Served) -> None:
    viewer.open(served.console.address, ready=".leaf")
    served.close()
    with closing(socket.create_server(("127.0.0.1", served.browser.port))):  # accepts connections, and never answers
        viewer.escape_twice()
        viewer.shows("NOT SENT", ".rest-said")


def test_a_page_is_live_again_with_each_entry_once(viewer: Viewer, served: Served, hosted: Hosted) -> None:
    viewer.open(served.console.address, ready=".leaf")
    until(lambda: positions(viewer), HANG)
    served.close()
    viewer.shows("console does not answer", ".connection")
    begun = positions(viewer)
    hosted.exhibition.stop()
    with ExitStack() as stack:
        again = Served(hosted.root, served.browser.port)
        stack.callback(again.close)
        until(lambda: viewer.text(".connection").startswith("live"), HANG)
        viewer.click(".rest")
        viewer.shows("Rests", ".rest-said")
        until(lambda: "by" in " ".join(texts(viewer)), HANG)
        shown = positions(viewer)
    assert shown == begun + list(range(begun[-1] + 1, begun[-1] + 1 + len(shown) - len(begun)))


def positions(viewer: Viewer) -> list[int]:
    """Return the positions of the entries that the page has received."""
    return [int(entry["position"]) for entry in entries(viewer)]


def texts(viewer: Viewer) -> list[str]:
    return [str(entry["text"]) for entry in entries(viewer)]


def entries(viewer: Viewer) -> list[dict[str, object]]:
    script = "const done = arguments[0]; import('/pages/live.js').then(({ live }) => done(live.entries))"
    return list(viewer.driver.execute_async_script(script))


NEWS_AT_ONCE = """
const done = arguments[0];
import("/pages/ui.js").then(({ html, redraw, render, useRedraw }) => {
  let news = "none";
  const box = document.createElement("p"), Shown = () => { useRedraw(); return news; };
  render(html`<${Shown} />`, box);
  news = "some";
  redraw();
  requestAnimationFrame(() => setTimeout(() => done(box.textContent), 0));
});
"""


def test_news_between_the_first_drawing_and_its_frame_is_drawn(viewer: Viewer, served: Served) -> None:
    viewer.open(served.console.address, "robot/NAO", ready=".leaf")
    assert viewer.driver.execute_async_script(NEWS_AT_ONCE) == "some"


@pytest.mark.parametrize("theme", ["light", "dark"])
@pytest.mark.parametrize("page", PAGES)
def test_axe_finds_nothing(viewer: Viewer, served: Served, page: str, theme: str) -> None:
    path, ready = PAGES[page]
    language = "id" if theme == "dark" else "en"
    viewer.open(served.console.address, path, ready=ready, theme=theme, mode="author", language=language)
    viewer.run((fetched("console") / "axe-core/axe.min.js").read_text("utf-8"))
    found = viewer.driver.execute_async_script("axe.run().then(arguments[0])")
    assert [(one["id"], [node["target"] for node in one["nodes"]]) for one in found["violations"]] == []
    assert len(found["passes"]) > 5


@pytest.mark.parametrize("page", PAGES)
def test_a_phone_shows_all_of_it_and_rest_whole(viewer: Viewer, served: Served, page: str) -> None:
    path, ready = PAGES[page]
    viewer.open(served.console.address, path, ready=ready, width=NARROW)
    assert viewer.run("return document.documentElement.scrollWidth") <= NARROW
    if page in OPERATORS:
        box = viewer.run("return document.querySelector('.rest').getBoundingClientRect().toJSON()")
        assert 0 <= box["left"] < box["right"] <= NARROW
        assert box["top"] >= 0
        assert min(box["width"], box["height"]) >= TOUCH


def test_rest_stands_in_the_same_place_on_all_pages(viewer: Viewer, served: Served) -> None:
    places = set()
    for page in OPERATORS:
        path, ready = PAGES[page]
        viewer.open(served.console.address, path, ready=ready)
        box = viewer.run("return document.querySelector('.rest').getBoundingClientRect().toJSON()")
        places.add((box["left"], box["top"], box["width"], box["height"]))
    assert len(places) == 1


def test_what_fingers_press_is_large_enough(viewer: Viewer, served: Served) -> None:
    viewer.open(served.console.address, ready=".leaf", width=NARROW, mode="author")
    small = viewer.run(
        "return [...document.querySelectorAll('button, select, input:not([type=radio]), nav a')]"
        ".filter(e => e.offsetParent && e.getBoundingClientRect().height < arguments[0]).map(e => e.outerHTML)",
        TOUCH,
    )
    assert small == []


def test_the_keyboard_reaches_rest_and_everything_says_where_it_is(
    viewer: Viewer, served: Served, hosted: Hosted
) -> None:
    viewer.open(served.console.address, ready=".leaf")
    seen = []
    for _ in range(60):
        viewer.type(Keys.TAB)
        name, outline = viewer.run(
            "const e = document.activeElement; return [e.innerText || e.tagName, getComputedStyle(e).outlineStyle]"
        )
        seen.append(name)
        assert outline != "none", name
        if name.startswith("Rest"):
            break
    assert seen[0] == "Skip to content"
    assert {"Now", "The day", "Files", "See", "Subtitles"} <= set(seen)
    viewer.type(Keys.ENTER)
    viewer.shows("Rests", ".rest-said")
    assert rests(hosted)


def test_what_somebody_says_is_text_and_never_markup(viewer: Viewer, served: Served) -> None:
    viewer.open(served.console.address, ready=".leaf")
    said = "<img src=x onerror=alert(1)><script>alert(1)</script>"
    until(lambda: served.browser.command("event", event="face", data={"x": 160, "y": 120}).data["state"] == "finished")
    served.browser.command("event", event="heard", data={"result": said})
    viewer.shows(said, ".talk-lines")
    until(lambda: viewer.all(".entry"), HANG)
    viewer.run("document.querySelector('.entries').scrollIntoView()")  # what is not seen is not laid out
    viewer.shows(said, ".entries")
    assert viewer.all("main img, main script") == []


def test_the_language_is_switched_and_kept(viewer: Viewer, served: Served) -> None:
    viewer.open(served.console.address, ready=".leaf", language="id")
    viewer.shows("Istirahat", ".rest")
    viewer.shows("Percakapan", "main")
    assert viewer.run("return document.documentElement.lang") == "id"


def test_a_button_that_is_held_does_it_and_one_that_is_only_pressed_does_not(viewer: Viewer, served: Served) -> None:
    viewer.open(served.console.address, ready=".leaf")
    until(lambda: served.browser.command("event", event="face", data={"x": 160, "y": 120}).data["state"] == "finished")
    viewer.shows("End the visit", ".declared")
    viewer.click(".declared")
    assert "End the visit" not in viewer.text(".told")
    viewer.hold(lambda: viewer.all(".declared")[0], "End the visit: done")
    viewer.shows("goodbye", ".leaf")
    assert viewer.complaints() == []


def test_a_button_that_was_held_long_enough_does_it_on_a_busy_page_too(viewer: Viewer, served: Served) -> None:
    viewer.open(served.console.address, ready=".leaf")
    until(lambda: served.browser.command("event", event="face", data={"x": 160, "y": 120}).data["state"] == "finished")
    viewer.shows("End the visit", ".declared")
    viewer.run(HELD, 999)
    assert "End the visit" not in viewer.text(".told")
    viewer.run(HELD, 1000)
    viewer.tells("End the visit: done")


def test_a_fork_shows_what_would_have_been_beside_what_was(
    viewer: Viewer, served: Served, hosted: Hosted, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(forking, "PATIENCE", HANG)
    hosted.send("face", {"x": 160, "y": 120})
    until(lambda: "ask_name" in hosted.exhibition.configuration, HANG)
    hosted.send("heard", {"result": "my name is Budi", "language": "en"})
    until(lambda: hosted.exhibition.context["visitor"] == "Budi", HANG)
    viewer.open(served.console.address, "robot/NAO/day", ready=".day .entry", mode="author")
    choose = (
        "const one = [...document.querySelectorAll('.entry button')].find((e) => e.textContent.includes('is Budi'));"
    )
    until(lambda: viewer.run(f"{choose} one?.click(); return Boolean(one)"), HANG)
    viewer.run(INSTEAD, "event")
    viewer.click(".fork input[list]")
    viewer.type("operator.end")
    viewer.click(".fork .strong")
    viewer.shows("operator.end", ".beside > :last-child .differs")
    viewer.shows("goodbye", ".beside > :last-child .differs")
    viewer.shows("my name is Budi", ".beside > :first-child .differs")
    assert "operator.end" not in viewer.text(".beside > :first-child")
    viewer.click(".what-if")
    until(lambda: viewer.run("return document.activeElement.matches('.fork input.words')"), HANG)
    viewer.type("my name is Ani", Keys.ENTER)
    viewer.shows("my name is Ani", ".beside > :last-child .differs")
    assert violations(viewer) == []
