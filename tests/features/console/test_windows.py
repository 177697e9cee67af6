"""Many windows of one browser, which has six connections for a server: all of them are live, and Rest goes through."""

import json
from collections.abc import Iterator
from threading import Event, Thread

import pytest

from tests.features.console.chromium import REST, Chromium
from tests.features.console.conftest import Hosted
from tests.features.console.pages import Served
from tests.features.console.test_rest import RESTS
from tests.waiting import HANG, until

WINDOWS = 8
KEY = "avatar.NAO.data.image"
LAST = """
const done = arguments[arguments.length - 1];
import("/pages/live.js").then(({ live }) => done([live.state, live.entries.at(-1)?.position ?? -1]));
"""
LATE = """
const press = { id: "of-before", robot: "NAO", told: ["finished", { seconds: 0.5 }], at: Date.now() - 60000 };
sessionStorage.setItem("lumen.pressed", JSON.stringify({ ...press, told: arguments[0] ?? press.told }));
"""
"""Stores a press of a minute ago whose answer no page has shown for long enough."""
REPORTS = """
const button = document.querySelector("rest-button[main]"), robot = { robot: "NAO", connected: true };
Object.assign(button, { sent: { robot: "NAO", at: Date.now() - 6000 } }).show("finished", { seconds: 5 });
button.rested = false;
return arguments[0].map((stopped) => { button.heed([{ ...robot, stopped }]); return !button.said.hidden; });
"""
"""Returns after each of these reports whether the answer to a press of a while ago is still shown."""
ALARMED = """
const button = document.querySelector("rest-button[main]");
button.heed([{ robot: "NAO", connected: true, stopped: true }]);
button.heed = ((heed) => (robots) => { if (!robots) heed.call(button); })(button.heed); // the robot reports nothing new
button.show("unsent");
"""
OUTDATED = """
const button = document.querySelector("rest-button[main]"), robot = { robot: "NAO", connected: true, stopped: true };
const { fetch } = globalThis, done = arguments[0];
globalThis.fetch = (path, options) => {
  const answer = fetch(path, options);
  const settle = () => (button.verifying ? setTimeout(settle, 10) : done(button.innerText));
  if (path === "/api/now") answer.finally(settle);
  return answer;
};
Object.assign(button, { sent: { robot: "NAO", at: Date.now() - 60000 } }).show("unsent");
button.heed([robot]);
"""
"""Reports that the robot rests, as it did before the press; returns what is said after the page has asked."""
OVERTAKEN = """
const button = document.querySelector("rest-button[main]"), { fetch, setTimeout } = globalThis, held = [];
globalThis.setTimeout = (run, after, ...more) => (after === 5000 ? 0 : setTimeout(run, after, ...more));
globalThis.fetch = (path, options) =>
  path === "/api/now" && !held.length ? new Promise((answer) => held.push(answer)) : fetch(path, options);
for (const id of ["first", "second"]) {
  Object.assign(button, { sent: { id, robot: "NAO", at: Date.now() - 60000 } }).show("unsent");
  button.heed([{ robot: "NAO", connected: true, stopped: true }]);
}
button.heed = ((heed) => (robots) => { if (!robots) heed.call(button); })(button.heed); // the robot reports nothing new
held[0](fetch("/api/now"));
"""
"""Presses again while the page asks whether the robot rests after all; then the answer comes, and no timer helps."""
HELD = """
const { fetch } = globalThis, answers = (globalThis.answers = []);
const held = () => new Promise((answer) => answers.push((state) => answer(Response.json({ state }))));
globalThis.fetch = (path, options) => (path === "/api/commands" ? held() : fetch(path, options));
"""
"""Holds the answers to commands back until `answers[n](state)`."""
UNREAD = """
const later = setTimeout;
globalThis.setTimeout = (run, after, ...more) => after === 2000 ? 0 : later(run, after, ...more);
"""
"""Keeps the page from forgetting the answer to Rest after 2 s: the next page may take longer."""
SEEN = "const seen = document.querySelector('main img'); return Boolean(seen && seen.complete && seen.naturalWidth);"
PIXEL = f"/9j/4AAQSkZJRgABAQEASABIAAD/2wBDAP{'/' * 86}wgALCAABAAEBAREA/8QAFBABAAAAAAAAAAAAAAAAAAAAAP/aAAgBAQABPxA="
"""A JPEG of one pixel."""


@pytest.fixture
def filmed(hosted: Hosted) -> Iterator[Hosted]:
    """An exhibition whose robot sends ten images a second."""
    ending = Event()

    def film() -> None:
        while not ending.wait(0.1):
            url = f"data:image/jpeg;base64,{PIXEL}"
            hosted.exhibition.node.bus.publish(KEY, {"name": "1", "contentType": "image/jpeg", "contentUrl": url})

    thread = Thread(target=film)
    thread.start()
    yield hosted
    ending.set()
    thread.join()


@pytest.mark.slow
def test_eight_windows_that_see_are_live_and_rest_goes_through(
    filmed: Hosted, served: Served, chromium: Chromium
) -> None:
    watch = served.console.site.watch
    windows = [str(chromium.driver.current_window_handle), *(chromium.window() for _ in range(WINDOWS - 1))]
    for window in windows:
        chromium.look(window)
        chromium.open(f"{served.console.address}robot/NAO/see")
        until(lambda: chromium.run(SEEN), HANG)
    served.browser.command("mark", text="he waved")
    position = served.browser.robots[0]["position"]
    for window in windows:
        chromium.look(window)
        until(lambda: _last(chromium) >= position, HANG)
        assert chromium.run("return document.hidden") is False
        until(lambda: chromium.run(SEEN), HANG)
    until(lambda: watch.lookers == 1, HANG)  # one stream for all of them
    chromium.rest()
    until(lambda: "Rests" in chromium.said(), HANG)
    for window in windows:
        chromium.look(window)
        until(lambda: chromium.run("return document.querySelector('main') !== null"), HANG)
    for window in windows[1:]:
        chromium.look(window)
        chromium.driver.close()
    chromium.look(windows[0])
    served.browser.command("mark", text="he has gone")
    position = served.browser.robots[0]["position"]
    until(lambda: _last(chromium) >= position, HANG)


@pytest.mark.slow
def test_what_came_of_rest_is_told_by_the_next_page_too_where_nobody_could_read_it(
    served: Served, hosted: Hosted, chromium: Chromium
) -> None:
    """A user who presses and leaves at once sees the answer on the next page; a closed notice does not come again."""
    before = _commands(served)
    chromium.open(served.console.address)
    chromium.find(REST)
    chromium.run(UNREAD)
    chromium.rest()
    until(lambda: "Rests" in chromium.said(), HANG)
    chromium.open(f"{served.console.address}robot/NAO/see")
    until(lambda: chromium.run("return location.pathname") == "/robot/NAO/see", HANG)
    until(lambda: "Rests" in chromium.said(), HANG)
    assert [entry["command"] for entry in _commands(served)[len(before) :]] == ["rest"]  # it is the same one
    chromium.quiet()
    chromium.open(f"{served.console.address}robot/NAO/files")
    until(lambda: chromium.run("return location.pathname") == "/robot/NAO/files", HANG)
    until(lambda: _last(chromium) >= 0, HANG)
    assert chromium.said() == ""


@pytest.mark.slow
@pytest.mark.parametrize("read", [True, False], ids=["reported", "still sent"])
def test_a_next_page_that_comes_late_reports_rest_without_sending_it_again(
    served: Served, hosted: Hosted, chromium: Chromium, read: bool
) -> None:
    """A page may take long to load: it reports an unread answer however late it is there."""
    chromium.open(served.console.address)
    chromium.rest()
    until(lambda: "Rests" in chromium.said(), HANG)
    before = _commands(served)
    told = chromium.run(LATE, None if read else ["sent", {}])
    chromium.open(f"{served.console.address}robot/NAO/see")
    until(lambda: chromium.run("return location.pathname") == "/robot/NAO/see", HANG)
    until(lambda: "Rests" in chromium.said(), HANG)
    assert ("after all" in chromium.said()) is not read, told
    until(lambda: chromium.run("return sessionStorage.getItem('lumen.pressed')") is None, HANG)
    assert _commands(served) == before


@pytest.mark.slow
def test_a_report_from_before_a_press_hides_nothing(served: Served, hosted: Hosted, chromium: Chromium) -> None:
    """On a slow machine a robot's report may reach the page later than the answer to a press that came after it."""
    chromium.open(served.console.address)
    chromium.rest()
    until(lambda: "Rests" in chromium.said(), HANG)
    assert chromium.run(REPORTS, [False]) == [True]
    assert chromium.run(REPORTS, [False, True, False]) == [True, True, False]


@pytest.mark.slow
def test_an_alarm_is_corrected_though_the_robot_reports_nothing_new(
    served: Served, hosted: Hosted, chromium: Chromium
) -> None:
    """The console answers late, after the robot has reported that it rests."""
    chromium.open(served.console.address)
    chromium.rest()
    until(lambda: "Rests" in chromium.said(), HANG)
    chromium.run(ALARMED)
    until(lambda: "Rests after all" in chromium.said(), HANG)


@pytest.mark.slow
def test_an_alarm_is_not_corrected_by_a_report_from_before_the_press(
    served: Served, hosted: Hosted, chromium: Chromium
) -> None:
    """On a slow machine the page may learn late that a robot was resumed before a press that did not reach it."""
    chromium.open(served.console.address)
    chromium.find(REST)
    until(lambda: _last(chromium) >= 0, HANG)
    said = str(chromium.driver.execute_async_script(OUTDATED))
    assert "NOT SENT" in said
    assert not RESTS.search(said)


@pytest.mark.slow
def test_an_alarm_is_corrected_though_an_earlier_one_was_being_asked_about(
    served: Served, hosted: Hosted, chromium: Chromium
) -> None:
    chromium.open(served.console.address)
    chromium.rest()
    until(lambda: "Rests" in chromium.said(), HANG)
    chromium.run(OVERTAKEN)
    until(lambda: "Rests after all" in chromium.said(), HANG)


@pytest.mark.slow
def test_the_answer_to_an_earlier_press_is_not_the_last_ones(
    served: Served, hosted: Hosted, chromium: Chromium
) -> None:
    """The robot may be resumed between two presses, and the console may answer the first one late."""
    chromium.open(served.console.address)
    chromium.find("rest-button[main] button.rest")
    chromium.run(HELD)
    chromium.rest()
    chromium.rest()
    until(lambda: chromium.run("return answers.length") == 2, HANG)
    chromium.driver.execute_async_script(
        "const done = arguments[0]; answers[0]('finished'); setTimeout(done, 0); // after all that the answer causes"
    )
    assert not RESTS.search(chromium.said())
    chromium.run("answers[1]('finished')")
    until(lambda: RESTS.search(chromium.said()), HANG)


def _commands(served: Served) -> list[dict[str, str]]:
    """Return the commands that were sent, in the form that pages receive."""
    blocks = [block.partition(b"data: ")[2] for _, block in served.console.site.streams.commands]
    return [said for said in map(json.loads, blocks) if said["state"] == "sent"]


def _last(chromium: Chromium) -> int:
    """Return the position of the page's last entry, -1 if the page is not live."""
    state, position = chromium.driver.execute_async_script(LAST)
    return int(position) if state == "live" else -1
