"""Many windows of one browser, which has six connections for a server: all of them are live, and Rest goes through."""

import json
from collections.abc import Iterator
from threading import Event, Thread

import pytest

from tests.console.chromium import Chromium
from tests.console.conftest import Hosted
from tests.console.pages import Served
from tests.waiting import until

WINDOWS = 8
WAIT = 60.0
"""How long a page may take on a crowded machine [s]."""
KEY = "avatar.NAO.data.image"
LAST = """
const done = arguments[arguments.length - 1];
import("/pages/live.js").then(({ live }) => done([live.state, live.entries.at(-1)?.position ?? -1]));
"""
SEEN = "const seen = document.querySelector('main img'); return Boolean(seen && seen.complete && seen.naturalWidth);"
PIXEL = f"/9j/4AAQSkZJRgABAQEASABIAAD/2wBDAP{'/' * 86}wgALCAABAAEBAREA/8QAFBABAAAAAAAAAAAAAAAAAAAAAP/aAAgBAQABPxA="
"""A JPEG of one pixel."""


@pytest.fixture
def filmed(hosted: Hosted) -> Iterator[Hosted]:
    """An exhibition whose robot sees something."""
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
        until(lambda: chromium.run(SEEN), WAIT)
    served.browser.command("mark", text="he waved")
    position = served.browser.robots[0]["position"]
    for window in windows:
        chromium.look(window)
        until(lambda: _last(chromium) >= position, WAIT)
        assert chromium.run("return document.hidden") is False
        until(lambda: chromium.run(SEEN), WAIT)
    assert watch.lookers == 1  # one stream for all of them
    chromium.rest()
    until(lambda: "Rests" in chromium.said(), WAIT)
    for window in windows:
        chromium.look(window)
        until(lambda: chromium.run("return document.querySelector('main') !== null"), WAIT)
    for window in windows[1:]:
        chromium.look(window)
        chromium.driver.close()
    chromium.look(windows[0])
    served.browser.command("mark", text="he has gone")
    position = served.browser.robots[0]["position"]
    until(lambda: _last(chromium) >= position, WAIT)


@pytest.mark.slow
def test_what_came_of_rest_is_told_by_the_next_page_too_where_nobody_could_read_it(
    served: Served, hosted: Hosted, chromium: Chromium
) -> None:
    """Whoever presses and goes on at once sees the answer there; whoever has closed it is not told again."""
    before = _commands(served)
    chromium.open(served.console.address)
    chromium.rest()
    until(lambda: "Rests" in chromium.said(), WAIT)
    chromium.open(f"{served.console.address}robot/NAO/see")
    until(lambda: chromium.run("return location.pathname") == "/robot/NAO/see", WAIT)
    until(lambda: "Rests" in chromium.said(), WAIT)
    assert [entry["command"] for entry in _commands(served)[len(before) :]] == ["rest"]  # it is the same one
    chromium.quiet()
    chromium.open(f"{served.console.address}robot/NAO/files")
    until(lambda: chromium.run("return location.pathname") == "/robot/NAO/files", WAIT)
    until(lambda: _last(chromium) >= 0, WAIT)
    assert chromium.said() == ""


def _commands(served: Served) -> list[dict[str, str]]:
    """The commands that were sent, as pages are told."""
    blocks = [block.partition(b"data: ")[2] for _, block in served.console.site.streams.commands]
    return [said for said in map(json.loads, blocks) if said["state"] == "sent"]


def _last(chromium: Chromium) -> int:
    """The position of the last entry of a page that is live."""
    state, position = chromium.driver.execute_async_script(LAST)
    return int(position) if state == "live" else -1
