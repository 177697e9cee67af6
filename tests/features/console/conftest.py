"""An exhibition that runs in a thread, with its bus, and a console of it."""

import threading
import time
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from lumen.features.console import access, commands
from lumen.robot.bounded_robot import BoundedRobot
from lumen.run.exhibition import Exhibition
from lumen.run.making.modules import ModulesPlan
from lumen.run.plan import Plan
from lumen.run.recovery.run_directory import RunDirectory
from lumen.run.recovery.startup import startup_project
from lumen.run.setup import set_up, set_up_with
from tests.features.console.chromium import Chromium
from tests.features.console.house import House
from tests.features.console.pages import Browser, Served
from tests.features.console.viewer import Viewer
from tests.rabbitmq import RabbitMQ
from tests.seams.test_joints import Obedient
from tests.tour.conftest import copied, copy, project
from tests.waiting import UNLIMITED, until

__all__ = ["copy", "project"]


@pytest.fixture
def still(monkeypatch: pytest.MonkeyPatch) -> None:
    """The clock by which attempts at PINs are limited stands still."""
    now = time.monotonic()
    monkeypatch.setattr(access, "time", SimpleNamespace(monotonic=lambda: now, time=time.time))


class Hosted:
    """An exhibition of a project on its own bus or a broker's, with a recording robot, in real time, until closed.

    With `real_skills` another robot runs the code of skills, and the project's own modules are started.
    """

    def __init__(self, root: Path, bus: str = "memory://", *, real_skills: bool = False) -> None:
        self.root, self._ending = root, threading.Event()
        self.directory = RunDirectory(root)
        loaded = startup_project(root, self.directory, last_good=False, warn=print)
        options: dict[str, Any] = {"directory": self.directory, "reload": "manual"}
        if real_skills:
            options |= {"modules": ModulesPlan()}
        robot = BoundedRobot(Obedient(), loaded.body)
        setup = set_up_with(robot, None, 1.0) if real_skills else set_up("recording", loaded, "1")
        self.exhibition = Exhibition(Plan(loaded, setup, bus, options=options))
        self.exhibition.start()
        self._begun = self._state
        self._thread = threading.Thread(target=self._live)
        self._thread.start()

    def _live(self) -> None:
        while not self._ending.is_set():
            self.exhibition.tick()

    def send(self, route: str, body: dict[str, Any]) -> None:
        """Send a message as a module would."""
        self.exhibition.send(route, body)

    @property
    def _state(self) -> tuple[object, ...]:
        """The parts of the exhibition's state that a test may change."""
        one = self.exhibition
        return (
            one.configuration,
            one.context,
            one.robot.server.hold.stopped,
            one.loop.runtime.approvals.autonomy,
        )

    @property
    def unchanged(self) -> bool:
        """Whether the exhibition's state equals that at its start."""
        return self._state == self._begun

    def close(self) -> None:
        self._ending.set()
        self._thread.join()
        self.exhibition.close()
        self.directory.close(forget=True)


class Shared:
    """An exhibition and its console for the tests of a module; new ones replace them if a test has changed them."""

    def __init__(self, root: Path) -> None:
        self._root = root
        self._hosted: Hosted | None = None
        self._served: Served | None = None

    def hosted(self) -> Hosted:
        if self._hosted and not self._hosted.unchanged:
            self.close()
        if self._hosted is None:
            self._hosted = Hosted(self._root)
        return self._hosted

    def served(self) -> Served:
        if self._served is None or not self._served.serves:
            self._served = Served(self._root)
        one = self._served
        until(lambda: [robot["connected"] for robot in one.browser.robots] == [True])
        return one

    def close(self) -> None:
        if self._served and self._served.serves:
            self._served.close()
        if self._hosted:
            self._hosted.close()
        self._served = self._hosted = None


@pytest.fixture(autouse=True)
def patient(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let a command count as unsent only after HANG, because a busy machine may send it late."""
    monkeypatch.setattr(commands, "SENT_TIMEOUT", UNLIMITED)


@pytest.fixture(scope="module")
def shared(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Shared]:
    one = Shared(copied(tmp_path_factory.mktemp("shared")))
    yield one
    one.close()


@pytest.fixture
def hosted(shared: Shared) -> Hosted:
    return shared.hosted()


@pytest.fixture
def served(shared: Shared, hosted: Hosted) -> Served:
    return shared.served()


@pytest.fixture(scope="module")
def viewer() -> Iterator[Viewer]:
    """A window of one file of tests."""
    one = Viewer()
    yield one
    one.close()


@pytest.fixture
def browser(served: Served) -> Browser:
    return served.browser


@pytest.fixture
def house(copy: Path) -> Iterator[House]:
    """An exhibition on its own bus, and a console, in processes that a test may kill."""
    yield from lived_in(House(copy))


@pytest.fixture
def chromium() -> Iterator[Chromium]:
    """A new browser, without any earlier session on the console."""
    one = Chromium()
    yield one
    one.close()


@pytest.fixture(scope="package")
def begun_broker() -> Iterator[RabbitMQ]:
    rabbitmq = RabbitMQ()
    yield rabbitmq
    rabbitmq.stop()


@pytest.fixture
def own_broker(begun_broker: RabbitMQ) -> RabbitMQ:
    """A broker that a test may kill: it runs again for the next one."""
    if not begun_broker.runs:
        begun_broker.start()
    return begun_broker


@pytest.fixture
def house_on_a_broker(copy: Path, broker: RabbitMQ) -> Iterator[House]:
    """As `house`, but in more processes, on the broker of the run."""
    yield from lived_in(House(copy, broker))


@pytest.fixture
def house_on_its_broker(copy: Path, own_broker: RabbitMQ) -> Iterator[House]:
    """As `house_on_a_broker`, but on a broker that a test may kill."""
    yield from lived_in(House(copy, own_broker))


def lived_in(house: House) -> Iterator[House]:
    try:
        house.start()
        yield house
    finally:
        house.close()
