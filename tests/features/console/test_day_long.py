"""A long day, compressed: pages come and go while much happens; the console grows neither in memory nor in handles."""

import os
import sys
from collections.abc import Iterator, Sequence
from functools import partial
from pathlib import Path
from random import Random
from threading import Event, Thread

import pytest

from tests.features.console.chromium import Chromium
from tests.features.console.house import CONSOLE, House
from tests.features.console.pages import Stream
from tests.waiting import until

ROW = "  gender: {"
HEARD = "lumen.NAO.audio.gender.identification"
BATCH, EACH = 20, 0.05
"""Events per batch, and seconds between batches: 400 events a second."""
OPEN = 12
"""Pages that are open at the same time."""
BEHIND = 3_000
"""Most entries that a tab lacks: more than the console keeps, so it requests the others from the exhibition."""
MORE = 12.0
"""Megabytes by which the warm console may grow until the end."""
POOL = min(32, (os.cpu_count() or 1) + 4)
"""Threads in asyncio's pool for slow calls, started at the first use; Starlette has a pool, too."""
HANDLES = 6
"""Handles of connections that are about to end, and of requests for images."""
PAGES = ("", "robot/NAO", "robot/NAO/day", "robot/NAO/files", "robot/NAO/see", "robot/NAO/subtitles")
SHOWN = "return document.readyState === 'complete' && document.querySelector('main')?.innerText && location.pathname"
WAIT = 120.0


class Crowd:
    """A thread that sends `count` events; `left` are those still to come."""

    def __init__(self, house: House, count: int) -> None:
        self.left, self._house, self._pause = count, house, Event()
        self._thread = Thread(target=self._run)
        self._thread.start()

    def _run(self) -> None:
        while self.left > 0 and not self._pause.wait(EACH):
            for _ in range(BATCH):
                self._house.send(HEARD, {"gender": "male"})
            self.left -= BATCH

    def close(self) -> None:
        self.left = 0
        self._thread.join()


@pytest.fixture
def eager(copy: Path) -> Path:
    """A project that accepts more voices a second than real visitors have."""
    main = copy / "lumen.yaml"
    text = main.read_text("utf-8")
    assert ROW in text
    main.write_text(text.replace(ROW, f"{ROW}most: 2000/s, "), "utf-8")
    return copy


@pytest.fixture
def busy_house(eager: Path) -> Iterator[House]:
    one = House(eager)
    try:
        one.start()
        yield one
    finally:
        one.close()


def size(house: House) -> tuple[float, int, int]:
    """Return the memory [MB] and the numbers of threads and handles of the console."""
    process = Path(f"/proc/{house.processes[CONSOLE].pid}")
    status = dict(line.split(":\t", 1) for line in (process / "status").read_text().splitlines() if ":\t" in line)
    return int(status["VmRSS"].split()[0]) / 1024, int(status["Threads"]), len(os.listdir(process / "fd"))


def lived(house: House, events: int, tabs: int, looks: int) -> None:
    """Play `events` with `tabs` tabs and `looks` pages in Chromium, print the console's sizes and check its growth."""
    draw, begin = Random(18), house.insist_on({"ask": "now"})["position"]
    chromium, crowd, opened = Chromium(), Crowd(house, events), list[Stream]()
    sizes, seen, tab = list[tuple[float, int, int]](), 0, 0
    try:
        while crowd.left > 0 or tab < tabs:
            done = 1 - crowd.left / events
            while tab < tabs * done:
                opened.append(Stream(house.browser, f"/api/events?after={position(house) - draw.randrange(BEHIND)}"))
                seen += leave(opened.pop(draw.randrange(len(opened)))) if len(opened) > OPEN else 0
                tab += 1
                if tab % max(1, tabs // looks) == 0:
                    chromium.open(house.address + draw.choice(PAGES))
            if not sizes and position(house) - begin > BEHIND:
                seen += warmed(house, chromium)
                sizes.append(size(house))
            Event().wait(0.1)
        until(lambda: position(house) >= begin + events * 0.99, WAIT)  # some that came at once count as one
        until(lambda: caught_up(house, opened), WAIT)
    finally:
        crowd.close()
        chromium.close()
        seen += sum(leave(one) for one in opened)
    until(lambda: size(house)[2] <= sizes[0][2] + HANDLES, WAIT)
    sizes.append(size(house))
    (mb, threads, handles), (mb_then, threads_then, handles_then) = sizes
    sys.stdout.write(
        f"{position(house) - begin:,} entries, {tabs} tabs that took {seen:,}: warm {mb:.1f} MB, {threads} threads "
        f"and {handles} handles, at the end {mb_then:.1f} MB, {threads_then} and {handles_then}\n"
    )
    assert mb_then <= mb + MORE
    assert threads_then <= threads + 2 * POOL, "however many tabs there are"


def warmed(house: House, chromium: Chromium) -> int:
    """Request each answer and each page, with as many late tabs as there ever are, so that all memory is in use.

    Return the number of entries that these tabs received.
    """
    for path in ("/api/day", "/api/day.csv", "/api/why?what=idle", "/api/files", "/api/shape"):
        house.browser.get(path)
    for page in PAGES:
        chromium.open(house.address + page)
        until(partial(shows, chromium, page), WAIT)
    late = [Stream(house.browser, f"/api/events?after={position(house) - BEHIND}") for _ in range(OPEN)]
    until(lambda: caught_up(house, late), WAIT)
    return sum(leave(one) for one in late)


def shows(chromium: Chromium, page: str) -> bool:
    return bool(chromium.run(SHOWN) == f"/{page}")


def caught_up(house: House, pages: Sequence[Stream]) -> bool:
    """Return whether all these pages have the newest entry."""
    last = position(house)
    return all(page.of("entry") and page.of("entry")[-1].data["position"] >= last for page in pages)


def position(house: House) -> int:
    return int(house.browser.robots[0]["position"])


def leave(page: Stream) -> int:
    """Close a page, check that it received each entry once and in order, and return their number."""
    page.close()
    positions = [event.data["position"] for event in page.of("entry")]
    assert positions == list(range(positions[0], positions[0] + len(positions))) if positions else True
    return len(positions)


@pytest.mark.soak
def test_an_hour_of_it(busy_house: House) -> None:
    lived(busy_house, 5_000, 14, 2)


@pytest.mark.soak
def test_a_whole_day(busy_house: House) -> None:
    lived(busy_house, 100_000, 200, 20)
