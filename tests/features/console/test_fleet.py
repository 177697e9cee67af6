"""Many houses in the console: houses, robots, the steps of a rollout, and its stop."""

import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from lumen.bus.memory import MemoryBus
from lumen.features.console import fleet_pages
from lumen.features.console.people import Role
from lumen.features.console.serving import Console
from lumen.run.reaching import Reached
from tests.features.console.languages import english_on
from tests.features.console.pages import Browser
from tests.features.console.viewer import Viewer
from tests.features.fleet.houses import changed
from tests.features.fleet.test_centre import PLAN, Hall
from tests.fetched import fetched
from tests.waiting import HANG, until

pytestmark = [pytest.mark.slow]


class Watched:
    """A centre with its robots, which tick on a thread, and a console on its bus."""

    def __init__(self, folder: Path) -> None:
        self.hall, self._ending, self.alone = Hall(folder), threading.Event(), threading.Lock()

        def reach() -> Reached:
            return Reached(MemoryBus(f"fleet-{folder.name}"), "nao1", "command", "stop")

        self.console = Console(reach, self.hall.root, "127.0.0.1", 0, pins={Role.OPERATOR: "12345"})
        self.browser = Browser(self.console.address)
        self._threads = [threading.Thread(target=each) for each in (self._live, self.console.run)]
        for thread in self._threads:
            thread.start()

    def _live(self) -> None:
        while not self._ending.wait(0.05):
            with self.alone:  # a centre is used on one thread at a time
                self.hall.look()

    def close(self) -> None:
        self._ending.set()
        self.console.end()
        for thread in self._threads:
            thread.join()
        self.hall.served.close()


@pytest.fixture
def watched(tmp_path: Path) -> Iterator[Watched]:
    found = Watched(tmp_path)
    yield found
    found.close()


def test_the_page_shows_the_fleet_and_stops_its_rollout(viewer: Viewer, watched: Watched) -> None:
    address, bearer = watched.console.address, {"Authorization": "Bearer 12345"}
    assert watched.browser.get("/api/fleet").status == 401
    assert watched.browser.post("/api/fleet", {"decision": "abort"}).status == 401
    until(lambda: watched.browser.get("/api/fleet", **bearer).status == 200, HANG)
    assert watched.browser.post("/api/fleet", {"decision": "rollout"}, **bearer).status == 400
    answer = watched.browser.post("/api/fleet", {"decision": "abort"}, **bearer)
    assert (answer.status, answer.data["reason"]) == (409, "no rollout is under way")

    viewer.open(address, "fleet", ready="main button")
    viewer.run(
        "return fetch('/api/session', {method: 'POST', headers: {'Content-Type': 'application/json'},"
        " body: JSON.stringify({pin: '12345', name: 'Ani'})})"
    )
    with watched.alone:
        hash = watched.hall.publish(changed(watched.hall.root))
        watched.hall.ask("rollout", bundle=hash, **{**PLAN, "pause": 3600.0})
    until(lambda: watched.hall.have(hash) == 1, HANG)
    viewer.driver.get(address)  # a centre without a robot of its own begins with its fleet
    viewer.shows("All houses", "main h1")
    viewer.shows("demo-1 at most 1 robot under way", ".steps")
    viewer.shows(hash[:12], ".house")
    viewer.shows("6 of 6 robots connected", "main")
    viewer.run("import('/pages/ui.js').then(({ speak }) => speak('id'))")
    viewer.shows("6 dari 6 robot terhubung", "main")
    assert english_on(viewer) == []
    viewer.run("import('/pages/ui.js').then(({ speak }) => speak('en'))")
    viewer.shows("6 of 6 robots connected", "main")
    assert viewer.all("rest-button[main]")
    viewer.run((fetched("console") / "axe-core/axe.min.js").read_text("utf-8"))
    assert viewer.driver.execute_async_script("axe.run().then((found) => arguments[0](found.violations))") == []
    viewer.click(".rollout .actions button.strong")
    viewer.shows("Roll back all robots?", "dialog")
    viewer.click("dialog button.strong")
    viewer.shows("aborted", ".rollout")
    viewer.shows("by Ani", ".rollout")
    until(lambda: watched.hall.have(hash) == 0, HANG)
    assert viewer.complaints() == []


def test_where_no_centre_is_the_page_says_so(watched: Watched, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(fleet_pages, "ANSWER_TIMEOUT", 0.2)
    watched.hall.served._desk.close()
    answer = watched.browser.get("/api/fleet", Authorization="Bearer 12345")
    assert answer.status == 503
    assert "no fleet centre answers" in answer.data["reason"]
