"""One browser and one broker for a run of pytest, however many workers it has; each test has a part of its own in them.

The process that was called as `pytest` (with xdist: not its workers) listens on a port, of which its workers learn
from the environment. A worker that asks there for a server gets the one of the run, which is started at the first
request. Servers are guarded children of that process: they end with it, however it ends, and the processor time
of a run includes theirs. A part ends with the worker that owns it: a browser context with its connection; and no one
else is given a virtual host that was given once.
"""

import json
import os
import shutil
import signal
import socket
import threading
from collections.abc import Iterator
from contextlib import suppress
from itertools import count
from typing import Any

import pytest

from tests import ROOT
from tests.guarded import STDOUT, Guarded, TimeoutExpired, temporary_folder
from tests.provided import program
from tests.rabbitmq import GIVEN, VIRTUAL_HOSTS, GivenBroker, LentBroker, RabbitMQ
from tests.waiting import HANG, UNLIMITED, until

PORT = "LUMEN_TEST_SERVERS"
"""The environment's name for the port."""
EVIL = "evil.example"
"""A name bound to this machine by its DNS; any other name is unknown to the browser."""
SWITCHES = (
    "headless=new",
    "no-sandbox",  # root has none
    "disable-gpu",
    "disable-dev-shm-usage",
    "disable-component-update",
    "no-first-run",
    "no-proxy-server",
    "disable-background-networking",
    "disable-background-timer-throttling",
    "disable-backgrounding-occluded-windows",
    "disable-renderer-backgrounding",
    "process-per-site",  # the next page of a window reuses the process of the last one
    "force-prefers-reduced-motion",
    "hide-scrollbars",
    "lang=en-GB",
    # Without it each window has two hidden pages of the address bar: half of the cost of a window.
    "disable-features=WebUIOmniboxPopup,WebUIOmniboxAimPopup,WebUIOmniboxFullPopup,AimEnabled,OmniboxPopup",
    f"host-resolver-rules=MAP {EVIL} 127.0.0.1, MAP * ~NOTFOUND, EXCLUDE 127.0.0.1",
    "remote-debugging-port=0",
)
STOP_TIMEOUT = 20.0
"""The time that Chromium may need to end in order, before it is killed [s]."""
UNPACKED = ROOT / ".cache/debian/root/usr/lib/chromium/chromium"
"""Chromium as scripts/packages.sh unpacks it; the script of that name on the PATH starts one in /usr only."""


class Chromium:
    """Debian's Chromium without a screen; developer tools listen on `port`, and as a whole at `address`."""

    def __init__(self) -> None:
        self._folder = temporary_folder("lumen-chromium-")
        told, log = self._folder / "DevToolsActivePort", self._folder / "log"
        switches = (*SWITCHES, f"user-data-dir={self._folder}")
        line = [
            UNPACKED if UNPACKED.exists() else program("chromium"),
            *(f"--{one}" for one in switches),
            "about:blank",
        ]
        with log.open("wb") as file:
            self._process: Guarded[bytes] = Guarded(line, stdout=file, stderr=STDOUT)
        ended = self._process.poll
        try:
            until(lambda: ended() is not None or (told.exists() and told.read_text().count("\n")), HANG)
        except AssertionError:
            self.close()
            raise
        if ended() is not None:
            pytest.fail(f"Chromium did not start; it printed:\n{log.read_text(errors='replace')[-2000:]}")
        port, path = told.read_text().split()
        self.port, self.address = int(port), f"ws://127.0.0.1:{port}{path}"

    @property
    def runs(self) -> bool:
        """Return whether it runs and listens: a crashed Chromium exists for a while."""
        with suppress(OSError), socket.create_connection(("127.0.0.1", self.port), HANG):
            return self._process.poll() is None
        return False

    def close(self) -> None:
        with suppress(ProcessLookupError):
            self._process.terminate()
            with suppress(TimeoutExpired):
                self._process.wait(STOP_TIMEOUT)
            os.killpg(self._process.pid, signal.SIGKILL)
        self._process.wait()
        shutil.rmtree(self._folder, ignore_errors=True)


class Servers:
    """Starts each server at the first request for it, and hands out parts; `port` accepts the requests."""

    def __init__(self) -> None:
        self._broker: RabbitMQ | None = None
        self._chromium: Chromium | None = None
        self._turns = {"broker": threading.Lock(), "chromium": threading.Lock()}
        self._numbers = count()
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.port = int(self._listener.getsockname()[1])
        threading.Thread(target=self._listen, daemon=True).start()

    def close(self) -> None:
        """End the servers. A server that is being started meanwhile ends with this process."""
        self._listener.close()
        for server in (self._broker, self._chromium):
            if isinstance(server, RabbitMQ):
                server.stop()
            elif server:
                server.close()

    def _listen(self) -> None:
        with suppress(OSError):  # it was closed
            while True:
                asking, _ = self._listener.accept()
                threading.Thread(target=self._answer, args=(asking,), daemon=True).start()

    def _answer(self, asking: socket.socket) -> None:
        with asking, suppress(OSError), asking.makefile("rw") as lines:
            name = lines.readline().strip()
            try:
                with self._turns[name]:
                    answer = {"given": self._give_broker() if name == "broker" else self._give_chromium()}
            except pytest.skip.Exception as told:
                answer = {"skip": told.msg}
            except pytest.fail.Exception as told:
                answer = {"fail": told.msg}
            except Exception as error:
                answer = {"fail": f"no {name} could be started: {error!r}"}
            print(json.dumps(answer), file=lines, flush=True)

    def _give_broker(self) -> dict[str, Any]:
        if self._broker is None:
            broker = RabbitMQ(virtual_hosts=VIRTUAL_HOSTS)
            broker.start()
            self._broker = broker
        if not self._broker.runs:
            pytest.fail("the broker of this run has ended: a test that ends its broker starts one by `RabbitMQ()`")
        if (number := next(self._numbers)) >= VIRTUAL_HOSTS:
            pytest.fail(f"all {VIRTUAL_HOSTS} virtual hosts are used up: raise VIRTUAL_HOSTS in tests/rabbitmq.py")
        return {"port": self._broker.port, "epmd": self._broker.epmd, "host": f"t{number}"}

    def _give_chromium(self) -> dict[str, Any]:
        if self._chromium and not self._chromium.runs:  # the tests that used it have failed
            self._chromium.close()
            self._chromium = None
        if self._chromium is None:
            self._chromium = Chromium()
        return {"port": self._chromium.port, "address": self._chromium.address}


class Plugin:
    """Ends the servers of a run with it."""

    def __init__(self, servers: Servers) -> None:
        self._servers = servers

    def pytest_unconfigure(self) -> None:
        self._servers.close()


def pytest_configure(config: pytest.Config) -> None:
    if hasattr(config, "workerinput"):
        return
    servers = Servers()
    os.environ[PORT] = str(servers.port)
    config.pluginmanager.register(Plugin(servers))


def given(name: str) -> Any:
    """Return a part of the run's server named `name`; fail or skip the test without such a server."""
    where = ("127.0.0.1", int(os.environ[PORT]))
    with socket.create_connection(where, 2 * HANG) as asking, asking.makefile("rw") as lines:
        print(name, file=lines, flush=True)
        answer = json.loads(lines.readline())
    if "skip" in answer:
        pytest.skip(answer["skip"])
    if "fail" in answer:
        pytest.fail(answer["fail"], pytrace=False)
    return answer["given"]


@pytest.fixture
def patient_bus() -> Iterator[None]:
    """A bus on RabbitMQ that waits for a slow broker; a test of one of these limits sets it again."""
    limits = {"consumer.BIND_TIMEOUT": UNLIMITED, "amqp.CLOSE_TIMEOUT": UNLIMITED}  # after these two, a bus continues
    limits |= {"polled.BROKER_TIMEOUT": HANG, "broker.BROKER_TIMEOUT": HANG}
    with pytest.MonkeyPatch.context() as patch:  # of its own: a test may undo its patches
        for name, limit in limits.items():
            patch.setattr(f"lumen.features.rabbitmq.{name}", limit)
        patch.setattr("lumen.features.rabbitmq.broker.HEARTBEAT_INTERVAL", int(UNLIMITED))
        yield


@pytest.fixture(scope="module")
def broker() -> RabbitMQ | GivenBroker:
    """A virtual host of the run's broker for the tests of a module."""
    if url := os.environ.get(GIVEN):
        return GivenBroker(url)
    return LentBroker(**given("broker"))
