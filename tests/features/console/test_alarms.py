"""Alarms are seen on every page, and the last known state of a robot does not look like its present one."""

import re
from contextlib import closing

import pytest

from tests.features.console.conftest import Hosted
from tests.features.console.languages import english_on
from tests.features.console.pages import Served
from tests.features.console.viewer import Viewer
from tests.fetched import fetched
from tests.waiting import HANG, until

pytestmark = pytest.mark.slow
PAGES = {"": ".leaf", "/day": ".day", "/files": ".saved", "/see": ".picture"}
LISTEN = """
globalThis.heard = [];
globalThis.AudioContext = class {
  createOscillator() {
    const frequency = {};
    return { frequency, connect: (next) => next, start: () => heard.push(frequency.value), stop: () => {} };
  }
  createGain() { return { gain: {}, connect: (next) => next }; }
  close() {}
};
"""
"""Records the frequency of each sound instead of playing it."""
ICON = "return document.querySelector('link[rel=icon]').href"
LATER = "const now = Date.now; Date.now = () => now() + 3600e3;"
"""Sets the page's clock an hour ahead."""


def fall(served: Served) -> None:
    assert served.browser.command("event", event="fallen").data["state"] == "finished"


def calm(viewer: Viewer, served: Served) -> None:
    """Open the page with what happened in earlier tests marked as read."""
    viewer.open(served.console.address, "robot/NAO", ready=".leaf")
    read = "document.querySelectorAll('.notice.bad button').forEach((one) => one.click())"
    until(lambda: viewer.run(read) or viewer.text(".connection") == "live", HANG)


def test_a_fall_is_seen_on_every_page_until_somebody_has_read_it(viewer: Viewer, served: Served) -> None:
    calm(viewer, served)
    fall(served)
    axe = (fetched("console") / "axe-core/axe.min.js").read_text("utf-8")
    for page in PAGES:
        if page:
            viewer.click(f"nav a[href$='{page}']")
            viewer.shows("NAO: has fallen.", ".alarms")
        viewer.shows("look at the robot", ".connection[data-state=alarm]")
        until(lambda: viewer.driver.title.startswith("⚠ NAO: has fallen · NAO: "), HANG)
        until(lambda: "icon-alarm.svg" in viewer.run(ICON), HANG)
        until(lambda: viewer.all(PAGES[page]), HANG)  # noqa: B023  called at once
        viewer.run(axe)
        assert viewer.driver.execute_async_script("axe.run().then((found) => arguments[0](found.violations))") == []
    viewer.click(".alarms a")
    viewer.shows("Keep visitors away", ".notice.bad")
    viewer.click(".notice.bad button")
    until(lambda: viewer.text(".connection") == "live", HANG)
    until(lambda: "⚠" not in viewer.driver.title, HANG)


def test_an_alarm_is_heard_once_by_who_wants_a_sound(served: Served) -> None:
    with closing(Viewer(first=LISTEN)) as viewer:
        viewer.open(served.console.address, "robot/NAO/day", ready=".day")
        viewer.click(".settings > button")
        viewer.click("#settings input[type=checkbox]")
        until(lambda: len(viewer.run("return heard")) >= 3, HANG)  # so that a person knows how it sounds
        before = len(viewer.run("return heard"))
        fall(served)
        until(lambda: len(viewer.run("return heard")) >= before + 3, HANG)
        viewer.click("nav a[href$=files]")
        viewer.shows("has fallen", ".alarms")
        assert viewer.run("return heard") == []


def test_alarms_are_in_the_language_of_the_page(viewer: Viewer, served: Served) -> None:
    viewer.open(served.console.address, "robot/NAO/see", ready=".picture", language="id", width=360)
    fall(served)
    viewer.shows("NAO: jatuh.", ".alarms")
    assert english_on(viewer) == []
    assert viewer.run("return document.documentElement.scrollWidth") <= 360


def test_a_robot_that_does_not_answer_is_not_shown_as_if_it_did(viewer: Viewer, served: Served, hosted: Hosted) -> None:
    """Its time counts from its last answer, its clocks stand still, and nothing can be pressed but Rest."""
    hosted.send("face", {"x": 160, "y": 120})
    viewer.open(served.console.address, "robot/NAO", ready=".declared", mode="author")
    viewer.run("import('/pages/live.js').then(({ live }) => { live.since -= 7200e3; })")  # the page is open since long
    hosted.close()
    viewer.shows("the robot does not answer", ".connection")
    assert re.search(r"answer [\d:]*\d:\d\d$", viewer.text(".connection").replace("\n", " "))
    active = viewer.text(".leaf .since")
    viewer.run(LATER)
    until(lambda: re.search(r"answer 1:0\d:\d\d$", viewer.text(".connection").replace("\n", " ")), HANG)
    assert viewer.text(".leaf .since") == active
    assert viewer.text(".body .badge").splitlines()[0] == "Last known"
    pressed = "[...document.querySelectorAll('main button, main input, main select')]"
    harmless = ".entry button, .notice button, .chart-open"  # they show what is known, and send nothing
    usable = f"{pressed}.filter((one) => !one.matches(':disabled, [aria-disabled=true], {harmless}'))"
    assert viewer.run(f"return {usable}.map((one) => one.outerHTML)") == []
    assert viewer.all("rest-button[main] .rest:not(:disabled)")
