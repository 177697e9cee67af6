"""An exhibition that runs in a thread, with its bus, and a console of it."""

import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from lumen.app.exhibition import Exhibition
from lumen.app.recovery.run_directory import RunDirectory
from lumen.app.recovery.startup import startup_project
from lumen.app.setup import set_up
from tests.console.house import House
from tests.console.pages import Browser, Served
from tests.rabbitmq import RabbitMQ
from tests.tour.conftest import copy, project
from tests.waiting import until

__all__ = ["copy", "project"]


class Hosted:
    """An exhibition of a project on its own bus or a broker's, with a recording robot, in real time, until closed."""

    def __init__(self, root: Path, bus: str = "memory://") -> None:
        self.root, self._ending = root, threading.Event()
        self.directory = RunDirectory(root)
        loaded = startup_project(root, self.directory, last_good=False, warn=print)
        self.exhibition = Exhibition(
            loaded, set_up("recording", loaded, "1"), bus, run_directory=self.directory, reload="manual"
        )
        self.directory.open(self.exhibition.node.bus, bus, loaded)
        self.exhibition.start()
        self._thread = threading.Thread(target=self._live)
        self._thread.start()

    def _live(self) -> None:
        while not self._ending.is_set():
            self.exhibition.tick()

    def send(self, route: str, body: dict[str, Any]) -> None:
        """A message as a module would send it."""
        self.exhibition.send(route, body)

    def close(self) -> None:
        self._ending.set()
        self._thread.join()
        self.exhibition.close()
        self.directory.close(forget=True)


@pytest.fixture
def hosted(copy: Path) -> Iterator[Hosted]:
    one = Hosted(copy)
    yield one
    one.close()


@pytest.fixture
def served(copy: Path, hosted: Hosted) -> Iterator[Served]:
    one = Served(copy)
    until(lambda: any(robot["connected"] for robot in one.browser.robots))
    yield one
    one.close()


@pytest.fixture
def browser(served: Served) -> Browser:
    return served.browser


@pytest.fixture
def house(copy: Path) -> Iterator[House]:
    """An exhibition on its own bus, and a console, in processes that a test may kill."""
    yield from lived_in(House(copy, speed="4"))


@pytest.fixture
def house_on_a_broker(copy: Path) -> Iterator[House]:
    """The same in more processes, on a broker that a test may kill."""
    broker = RabbitMQ()
    broker.start()
    try:
        yield from lived_in(House(copy, broker, speed="4"))
    finally:
        broker.stop()


def lived_in(house: House) -> Iterator[House]:
    try:
        house.start()
        yield house
    finally:
        house.close()
