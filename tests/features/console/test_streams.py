"""Pages that listen: many of them, one that never reads, and one that was away for long."""

import asyncio
import socket
from types import SimpleNamespace
from typing import cast

import orjson
import pytest

from lumen.features.console import gate
from lumen.features.console.connections import cut_off
from lumen.features.console.entry_clock import ToldPage
from lumen.features.console.entry_ring import EntryRing
from lumen.features.console.known_robot import KnownRobot
from lumen.features.console.streams import Listener, Streams, positions_in
from lumen.features.console.watch import Changes, Watch
from tests.features.console.conftest import Hosted
from tests.features.console.pages import Browser, Served, Stream
from tests.tables import for_each
from tests.waiting import until


def test_positions_are_read_from_what_a_browser_sends() -> None:
    assert positions_in("12", "NAO") == {"NAO": 12}
    assert positions_in("NAO:12,NAO2:5", "") == {"NAO": 12, "NAO2": 5}
    assert positions_in("-1", "") == {"": -1}
    for nonsense in ("", "x", "NAO:", "9" * 40, "NAO:1e5,;"):
        assert positions_in(nonsense, "") == {}


def test_a_ring_says_what_it_has_and_what_it_has_not() -> None:
    ring = EntryRing("NAO")
    ring.begin(9)
    ring.add(ToldPage([{"position": 10 + number, "heard": "face", "at": number / 10} for number in range(3_000)]))
    ring.add(ToldPage([{"position": 3_009, "heard": "face", "at": 300.0}]))
    assert (ring.first, ring.last) == (1_009, 3_009)
    assert ring.after(1_008) is None
    found = ring.after(1_009)
    assert found
    assert [entry.position for entry in found] == list(range(1_010, 1_210))
    assert [entry.position for entry in ring.after(3_007) or ()] == [3_008, 3_009]
    assert ring.after(3_009) == []
    assert ring.after(9_999) == []


def test_a_page_that_begins_receives_what_has_a_text_however_many_faces_came_after_it() -> None:
    ring = EntryRing("NAO")
    ring.begin(-1)
    heard = {3: "touched", 5: "touched", 700: "touched"}
    ring.add(ToldPage([{"position": n, "heard": heard.get(n, "face"), "at": n / 10} for n in range(1_500)]))
    assert [entry.position for entry in ring.recent(100)] == [3, 5, 700, 1_499]
    assert [entry.position for entry in ring.recent(2)] == [700, 1_499]
    assert EntryRing("NAO").recent(100) == []


@for_each("after", range(-1, 5))
def test_a_page_that_has_some_entries_receives_those_after_them_and_the_robot(after: int) -> None:
    view = KnownRobot("NAO")
    view.entries.begin(-1)
    view.entries.add(ToldPage([{"position": n, "heard": "touched", "at": n / 10} for n in range(5)]))

    async def events() -> list[bytes]:
        watch = SimpleNamespace(robots={"NAO": view}, lookers=0, changes=Changes())
        listener = Listener("NAO", {"NAO": after}, full=True, once=True)
        return [block async for block in Streams(cast(Watch, watch)).events(listener)]

    _, *entries, now = asyncio.run(events())
    assert [int(block.split(b"\n")[1].removeprefix(b"id: ")) for block in entries] == [*range(after + 1, 5)]
    assert now == b"event: now\ndata: " + orjson.dumps(view.to_json(full=True)) + b"\n\n"


def test_many_pages_hear_the_same(browser: Browser, hosted: Hosted) -> None:
    streams = [Stream(browser, "/api/events?after=-1") for _ in range(20)]
    try:
        browser.command("rest")
        until(lambda: all("stop" in [e.data.get("heard") for e in stream.of("entry")] for stream in streams))
        assert len({tuple(stream.positions()[:2]) for stream in streams}) == 1
    finally:
        for stream in streams:
            stream.close()


def test_who_asks_once_gets_what_there_is_and_no_more(served: Served, hosted: Hosted) -> None:
    browser, view = served.browser, served.console.site.watch.robots["NAO"]
    browser.command("mark", text="he waved")
    last = browser.robots[0]["position"]
    until(lambda: view.entries.last >= last)
    with Stream(browser, "/api/events?after=-1&once=1") as stream:
        until(stream.ended.is_set)
    got = [int(position) for position in stream.positions()]
    assert got == list(range(got[0], got[-1] + 1))
    assert got[-1] >= last, "what came since it was asked may be there, too"
    assert [event.data["robot"] for event in stream.of("now")] == ["NAO"]


def test_who_never_reads_is_cut_off_and_nobody_else_hears_of_it(
    served: Served, hosted: Hosted, monkeypatch: pytest.MonkeyPatch
) -> None:
    watch = served.console.site.watch
    view = watch.robots["NAO"]
    with socket.create_connection((served.browser.host, served.browser.port)) as lazy, Stream(served.browser) as keen:
        lazy.sendall(b"GET /api/events HTTP/1.1\r\nHost: localhost\r\n\r\n")
        until(lambda: watch.lookers == 2)
        never_reads = lazy.getsockname()
        monkeypatch.setattr(gate, "READ_TIMEOUT", 0.5)
        # on a busy machine, the other one may read as late
        monkeypatch.setattr(gate, "cut_off", lambda client: cut_off(client) if client == never_reads else None)

        def told() -> bool:
            view.told({"padding": "x" * 1_000_000, "number": view.version})
            return watch.lookers == 1

        until(told)
        before = len(keen.of("now"))
        until(lambda: len(keen.of("now")) > before)
