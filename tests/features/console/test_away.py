"""A page that was away is live again soon, and has every entry once: the server was killed, the network or a wire cut.

The page itself collects the entries it receives; the test compares them with the journal, read over the bus.
"""

import sys
import time
from collections.abc import Callable, Iterator
from threading import Event, Thread
from typing import Any

import pytest

from tests.features.console.chromium import Chromium
from tests.features.console.conftest import lived_in
from tests.features.console.house import CONSOLE, House
from tests.tour.conftest import copied
from tests.waiting import HANG, until

HEARD = "lumen.NAO.audio.gender.identification"
EACH = 0.03
"""Seconds between two events: more come while a page is away than it would receive without a request."""
SHORT, FULL = 4.0, 30.0
"""Seconds for which the page is away."""
COLLECT = """
const done = arguments[arguments.length - 1];
import("/pages/live.js").then(({ live, listen }) => {
  Object.assign(globalThis, { live, taken: [], times: [] });
  listen((kind, data) => { if (kind === "entry") taken.push(data.position), times.push(Date.now() / 1000); });
  done();
});
"""


class Speaker:
    """A thread that sends the robot a voice, which it ignores, again and again until `close`."""

    def __init__(self, house: House) -> None:
        self.sent, self._house, self._ending = 0, house, Event()
        self._thread = Thread(target=self._speak)
        self._thread.start()

    def _speak(self) -> None:
        while not self._ending.wait(EACH):
            self._house.send(HEARD, {"gender": "male"})
            self.sent += 1

    def close(self) -> None:
        self._ending.set()
        self._thread.join()


class Window:
    """A window with one page, which records the entries that it receives."""

    def __init__(self, chromium: Chromium, handle: str, address: str) -> None:
        self._chromium, self._handle = chromium, handle
        chromium.look(handle)
        chromium.open(address)
        until(lambda: chromium.run("return document.readyState") == "complete", HANG)
        chromium.driver.set_script_timeout(HANG)
        chromium.driver.execute_async_script(COLLECT)
        until(lambda: self.taken and self.state == "live", HANG)  # it is live after all of the first ones
        self.begun = self.taken
        """The positions that the page received first: those of the latest entries with a text, and the newest."""

    def run(self, script: str) -> Any:
        self._chromium.look(self._handle)
        return self._chromium.run(script)

    @property
    def taken(self) -> list[int]:
        return list(self.run("return taken"))

    @property
    def state(self) -> str:
        return str(self.run("return live.state"))

    def time_of(self, number: int) -> float:
        """Return the time when the page received the entry of that number [s since 1970]."""
        return float(self.run(f"return times[{number}]"))


@pytest.fixture(scope="module")
def begun_house(tmp_path_factory: pytest.TempPathFactory) -> Iterator[House]:
    yield from lived_in(House(copied(tmp_path_factory.mktemp("house"))))


@pytest.fixture
def house(begun_house: House) -> House:
    """The house of the module, once the robot answers again after the last test."""
    begun_house.await_robot()
    return begun_house


def journaled(house: House, first: int, last: int) -> list[int]:
    """Return the positions in the journal from `first` to `last`, both included."""
    found: list[int] = []
    while not found or found[-1] < last:
        page = house.insist_on({"ask": "journal", "from": found[-1] + 1 if found else first})
        assert page["entries"], f"the journal ends at {found[-1:]}, the page had {last}"
        found += [entry["position"] for entry in page["entries"]]
    return [position for position in found if position <= last]


def away(house: House, chromium: Chromium, what: str, seconds: float, leave: Callable[[], object], back: Any) -> None:
    """Take two pages away and back while events happen; check that both have all entries, once and in order."""
    handles = (str(chromium.driver.current_window_handle), chromium.window())
    speaker = Speaker(house)
    try:
        addresses = (house.address, f"{house.address}robot/NAO")
        windows = [Window(chromium, *one) for one in zip(handles, addresses, strict=True)]
        leave()
        until(lambda: all(window.state == "away" for window in windows), HANG)
        before = [len(window.taken) for window in windows]
        enough = speaker.sent + seconds / EACH / 4
        Event().wait(seconds)
        until(lambda: speaker.sent > enough, HANG)
        back()
        moment = time.time()
        until(lambda: all(len(w.taken) > had for w, had in zip(windows, before, strict=True)), HANG)
        late = max(w.time_of(had) for w, had in zip(windows, before, strict=True)) - moment
        seen = max(window.taken[-1] for window in windows)
        until(lambda: all(window.taken[-1] > seen for window in windows), HANG)
    finally:
        speaker.close()
    for window in windows:
        taken = window.taken[len(window.begun) - 1 :]
        assert taken == journaled(house, taken[0], taken[-1])
    told = f"{what} for {seconds:g} s: live {max(late, 0.0):.1f} s after it was back; {len(windows[0].taken)} entries"
    sys.stdout.write(f"{told}, each once, none missing\n")


def killed(house: House) -> tuple[Callable[[], object], Callable[[], object]]:
    def back() -> None:
        house.begin(CONSOLE)
        until(house.listens, HANG)

    return lambda: house.kill(CONSOLE), back


@pytest.mark.slow
@pytest.mark.xdist_group("away")
def test_a_server_that_was_killed_and_started_again(house: House, chromium: Chromium) -> None:
    away(house, chromium, "console killed", SHORT, *killed(house))


@pytest.mark.slow
@pytest.mark.xdist_group("away")
def test_a_network_that_was_cut(house: House, chromium: Chromium) -> None:
    away(house, chromium, "network cut", SHORT, house.network.cut, house.network.mend)


@pytest.mark.slow
def test_a_server_that_was_started_again_before_its_broker_was_there(
    house_on_a_broker: House, chromium: Chromium
) -> None:
    """Pages come back to a console that has reached no robot yet."""
    house = house_on_a_broker
    assert house.wire
    wire = house.wire

    def leave() -> None:
        wire.refuse()
        house.kill(CONSOLE)

    def back() -> None:
        house.begin(CONSOLE)
        until(lambda: house.listens() and [one["connected"] for one in house.browser.robots] == [False], HANG)
        unreached = "return live.state === 'live' && [...live.robots.values()].every((one) => !one.connected)"
        until(lambda: chromium.run(unreached), HANG)
        wire.mend()

    away(house, chromium, "console killed, and its broker away,", SHORT, leave, back)


@pytest.mark.soak
@pytest.mark.xdist_group("away")
def test_a_network_that_was_cut_for_half_a_minute(house_on_a_broker: House, chromium: Chromium) -> None:
    house = house_on_a_broker
    away(house, chromium, "network cut", FULL, house.network.cut, house.network.mend)


@pytest.mark.soak
@pytest.mark.xdist_group("away")
def test_a_server_that_was_away_for_half_a_minute(house_on_a_broker: House, chromium: Chromium) -> None:
    away(house_on_a_broker, chromium, "console killed", FULL, *killed(house_on_a_broker))
