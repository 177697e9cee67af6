"""The console of a house: two robots of one process, each with its tile, its Rest, its camera and its why."""

import base64
import threading
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest

import lumen
from lumen.run.exhibition import Exhibition
from lumen.run.house import House
from lumen.run.plan import Plan
from lumen.run.recovery.run_directory import RunDirectory
from lumen.run.setup import set_up_house
from tests.features.console.pages import Served
from tests.features.console.viewer import Viewer
from tests.waiting import HANG, until

NAMES = ("ana", "ben")
PIXEL = base64.b64decode(
    "/9j/4AAQSkZJRgABAQEASABIAAD/2wBDAP//////////////////////////////////////////////////////////////////////////////////"
    "////wgALCAABAAEBAREA/8QAFBABAAAAAAAAAAAAAAAAAAAAAP/aAAgBAQABPxA="
)
"""The smallest picture that a browser shows."""


class HostedHouse:
    """The robots of a project in one thread and on one bus, as `lumen run` hosts them, until closed."""

    def __init__(self, root: Path) -> None:
        self.projects = {name: lumen.load(root, robot=name) for name in NAMES}
        setups = set_up_house("recording", self.projects, "1", dict.fromkeys(NAMES))
        self.directories = {name: RunDirectory(root, name) for name in NAMES}
        self.shows = {
            name: Exhibition(
                Plan(
                    self.projects[name],
                    setups[name],
                    f"memory://{root}",
                    options={"directory": self.directories[name], "fresh": True},
                )
            )
            for name in NAMES
        }
        self._house = House({name: show.services for name, show in self.shows.items()})
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._live)
        self._thread.start()

    @property
    def resting(self) -> list[str]:
        return [name for name, show in self.shows.items() if show.robot.server.hold.stopped]

    def _live(self) -> None:
        self._house.start()
        while not self._ending.is_set():
            self._house.tick()

    def close(self) -> None:
        self._ending.set()
        self._thread.join()
        self._house.close()
        for directory in self.directories.values():
            directory.close(forget=True)


@pytest.fixture
def hosted(two: Path) -> Iterator[HostedHouse]:
    one = HostedHouse(two)
    yield one
    one.close()


@pytest.fixture
def served(hosted: HostedHouse, two: Path) -> Iterator[Served]:
    with ExitStack() as stack:
        one = Served(two)
        stack.callback(one.close)
        until(lambda: {robot["robot"] for robot in one.browser.robots if robot["connected"]} == set(NAMES), HANG)
        yield one


@pytest.mark.slow
def test_each_of_one_process_has_its_tile_rest_camera_and_why(served: Served, hosted: HostedHouse) -> None:
    viewer = Viewer()
    try:
        viewer.open(served.console.address, ready=".tile:nth-child(2)")
        assert [one.text for one in viewer.all(".tile h2")] == [*NAMES]
        viewer.click("rest-button[robot=ben] .rest")
        viewer.shows("rests, stopped by", ".tile[aria-label=ben]")
        assert hosted.resting == ["ben"]
        viewer.until(lambda: viewer.text(".tile[aria-label=ana] > .badge") == "runs")
        viewer.click(".tile[aria-label=ana] h2 a")
        viewer.shows("waiting", ".leaf")
        assert not viewer.all(".stopped")
    finally:
        viewer.close()
    ana, ben = (hosted.shows[name] for name in NAMES)
    ana.send("face", {"x": 160, "y": 120})
    until(lambda: "greeting" in ana.configuration)
    browser = served.browser
    why = {name: browser.get(f"/api/why?robot={name}&what=greeting") for name in NAMES}
    assert why["ana"].status == 200
    assert why["ben"].status == 404
    for name in NAMES:
        assert browser.get(f"/api/shape?robot={name}").data["robot"] == name
    url = "data:image/jpeg;base64," + base64.b64encode(PIXEL).decode()
    assert browser.get("/camera/ben?still").status == 204

    def shown() -> bool:
        ben.node.bus.publish("avatar.ben.data.image", {"name": "1", "contentType": "image/jpeg", "contentUrl": url})
        return browser.get("/camera/ben?still").body == PIXEL

    until(shown)
    assert browser.get("/camera/ana?still").status == 204
