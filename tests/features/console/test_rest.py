"""Rest at any moment: the robot rests, or the page shows that it does not. In a real browser, on both buses.

The test asks the robot whether it rests, not the console. `LUMEN_TEST_SEED=5` draws other moments.
"""

import os
import re
import sys
from collections import Counter
from contextlib import suppress
from random import Random
from statistics import median, quantiles
from threading import Event

import pytest

from tests.features.console.chromium import Chromium
from tests.features.console.house import House
from tests.features.console.troubles import (
    LEAVING,
    LOADING,
    LONGEST,
    QUIET,
    WITH_BROKER,
    WITHOUT_BROKER,
    Happening,
    Trouble,
    drawn,
)
from tests.waiting import HANG, until

SEED = int(os.environ.get("LUMEN_TEST_SEED", "18"))
PAGES = ("", "robot/NAO", "robot/NAO/day")
RESTS = re.compile(r"Rests")
REFUSES = re.compile(r"NOT SENT|does not rest|no answer came|can't be sent")
LEAVES = """
sessionStorage.removeItem("test.read");
addEventListener("pagehide", () => {
  const said = document.querySelector("rest-button[main] .rest-said");
  if (!sessionStorage.getItem("lumen.pressed")) sessionStorage.setItem("test.read", said.innerText);
});
"""
"""Keeps a page's last Rest notice if it was shown so long that the next page need not repeat it (`SEEN`)."""
READ = "return sessionStorage.getItem('test.read') ?? ''"
TOOK = "return document.querySelector('rest-button[main]')?.told?.[1]?.seconds ?? null"


class Desk:
    """A person who presses Rest in a few windows of one console, with the outcomes."""

    def __init__(self, house: House, chromium: Chromium, draw: Random) -> None:
        self.house, self.draw, self.chromium = house, draw, chromium
        driver = self.chromium.driver
        self.windows = [str(driver.current_window_handle), *(self.chromium.window() for _ in PAGES[1:])]
        for window, page in zip(self.windows, PAGES, strict=True):
            self.chromium.look(window)
            self.chromium.open(house.address + page)
            self.chromium.find("rest-button[main] button.rest")
        self.times: list[float] = []
        self.outcomes = Counter[str]()
        self.silent: list[str] = []

    def live(self, trouble: Trouble) -> None:
        """Cause one trouble, and press Rest at random moments while it begins and lasts."""
        house, draw = self.house, self.draw
        pressed = draw.sample(self.windows, trouble.presses)
        for window in pressed:
            self.chromium.look(window)
            self.chromium.quiet()
        happening = Happening(trouble, house, draw.uniform(0, 0.4) if trouble.presses > 1 else 0.0)
        for window in pressed:
            self.chromium.look(window)
            if trouble is not QUIET:
                Event().wait(draw.uniform(0, 0.4))
            self.press(trouble)
        happening.mend(draw.uniform(0, LONGEST) if trouble.presses > 1 else 0.0)
        said = {window: self.hear(trouble, window) for window in pressed}
        rests = self.rests()
        for window in pressed:
            self.judge(trouble, window, said[window], rests=rests)
        house.resume()

    def rests(self) -> bool:
        """Return whether the robot is stopped, by its own answer."""
        said: list[str | None] = []
        until(lambda: said.append(self.house.stopped_by()) or said[-1] is not None, HANG)
        return bool(said[-1])

    def press(self, trouble: Trouble) -> None:
        house, draw = self.house, self.draw
        if trouble is LOADING:
            self.chromium.open(house.address + draw.choice(PAGES))
        self.chromium.rest(keys=draw.random() < 0.5)
        if trouble is LEAVING:
            self.chromium.run(LEAVES)
            self.chromium.open(house.address + draw.choice(PAGES))

    def read(self, trouble: Trouble) -> str:
        """Return the Rest notice of the page that was left; empty in any other trouble."""
        return str(self.chromium.run(READ)) if trouble is LEAVING else ""

    def hear(self, trouble: Trouble, window: str) -> str:
        """Wait for a page's final notice about Rest, and return it; empty if none comes."""
        self.chromium.look(window)
        said = ""

        def settled() -> bool:
            nonlocal said
            said = self.chromium.said() or self.read(trouble)
            return bool(RESTS.search(said) or REFUSES.search(said))

        with suppress(AssertionError):
            until(settled, HANG)
        return said

    def judge(self, trouble: Trouble, window: str, said: str, *, rests: bool) -> None:
        """Compare a page's notice with the robot's state; the page must correct a false alarm."""
        self.chromium.look(window)
        what = " ".join(said.split())
        if rests and REFUSES.search(said):
            what = " ".join(self.corrected().split())
            self.outcomes["said NOT, and then that it rests after all"] += bool(RESTS.search(what))
            if not RESTS.search(what):
                self.silent.append(f"{trouble.name}: rests, and the page still says “{what}”")
        elif RESTS.search(said) and not rests:
            self.silent.append(f"{trouble.name}: does not rest, and the page says “{what}”")
        elif not rests and not REFUSES.search(said):
            self.silent.append(f"{trouble.name}: does not rest, and the page says “{what}”, nothing else")
        elif rests and not said:
            self.silent.append(f"{trouble.name}: rests, and the page says nothing")
        else:
            self.outcomes["rests" if rests else "does not rest, as the page says"] += 1
            if rests and trouble.presses == 1 and isinstance(seconds := self.chromium.run(TOOK), float | int):
                self.times.append(float(seconds))

    def corrected(self) -> str:
        """Wait for the page's correction of an alarm, and return its notice."""
        with suppress(AssertionError):
            until(lambda: RESTS.search(self.chromium.said()), HANG)
        return self.chromium.said()


@pytest.fixture
def draw() -> Random:
    return Random(SEED)


def pressed(house: House, chromium: Chromium, draw: Random, troubles: tuple[Trouble, ...], presses: int) -> Desk:
    """Press Rest at least `presses` times in troubles, print the outcomes, and fail for each press without one."""
    desk = Desk(house, chromium, draw)
    lived = Counter[str]()
    for trouble in drawn(troubles, draw, presses):
        desk.live(trouble)
        lived[trouble.name] += trouble.presses
    lines = (
        f"Rest at {lived.total()} moments (seed {SEED}): silent failures {len(desk.silent)}",
        ", ".join(f"{name} {count}" for name, count in lived.most_common()),
        ", ".join(f"{what} {count}" for what, count in desk.outcomes.most_common()),
    )
    sys.stdout.write("\n  ".join(lines) + "\n")
    assert not desk.silent, "\n".join(desk.silent)
    return desk


def print_times(desk: Desk) -> None:
    """Print the times of Rest while nothing was broken."""
    p95 = quantiles(desk.times, n=20)[-1]
    sys.stdout.write(f"until the robot rests: median {median(desk.times):.2f} s, p95 {p95:.2f} s\n")


@pytest.mark.once
@pytest.mark.slow
@pytest.mark.xdist_group("rest")
def test_rest_at_6_moments_on_the_local_bus(house: House, chromium: Chromium, draw: Random) -> None:
    pressed(house, chromium, draw, WITHOUT_BROKER, 6)


@pytest.mark.slow
def test_rest_at_6_moments_on_a_broker(house_on_its_broker: House, chromium: Chromium, draw: Random) -> None:
    pressed(house_on_its_broker, chromium, draw, WITH_BROKER, 6)


@pytest.mark.soak
@pytest.mark.xdist_group("rest")
def test_rest_at_400_moments_on_the_local_bus(house: House, chromium: Chromium, draw: Random) -> None:
    print_times(pressed(house, chromium, draw, WITHOUT_BROKER, 400))


@pytest.mark.soak
@pytest.mark.xdist_group("rest on a broker")
def test_rest_at_600_moments_on_a_broker(house_on_its_broker: House, chromium: Chromium, draw: Random) -> None:
    print_times(pressed(house_on_its_broker, chromium, draw, WITH_BROKER, 600))
