"""Contexts of the run's Chromium (tests/servers.py), each with a driver session of its own."""

import json
import socket
from contextlib import suppress
from typing import Any

import pytest
import websocket
from selenium.common.exceptions import InvalidSessionIdException, WebDriverException
from selenium.webdriver import ChromeOptions, Remote
from selenium.webdriver.remote.client_config import ClientConfig

from tests.guarded import DEVNULL, Guarded
from tests.provided import program
from tests.servers import given
from tests.waiting import HANG, until

ENDED = "Chromium has ended while this test used it: it crashed, or was killed"


class DrivenBrowser:
    """A browser context with one window of this size [px]; it shares no storage, cookie, cache or worker with others.

    The driver keeps the `logs`: `browser` has the complaints of pages, `performance` their requests, which costs
    processor time with every message. The context ends with this process at the latest.
    """

    def __init__(self, *logs: str, size: tuple[int, int], page_load_strategy: str = "normal") -> None:
        self._browser, port = _connected()
        self._size = size
        self._context = self._browser.ask("Target.createBrowserContext", disposeOnDetach=True)["browserContextId"]
        options = ChromeOptions()
        options.debugger_address = f"127.0.0.1:{port}"
        options.page_load_strategy = page_load_strategy
        options.set_capability("goog:loggingPrefs", dict.fromkeys(logs, "ALL"))
        self.driver = _attached(options)
        self.window()

    def window(self) -> str:
        """Open another window of this context, which the driver uses from now on; return its handle."""
        width, height = self._size
        where = {"browserContextId": self._context, "newWindow": True, "width": width, "height": height}
        window = str(self._browser.ask("Target.createTarget", url="about:blank", **where)["targetId"])
        self.driver.switch_to.window(window)
        return window

    def close(self) -> None:
        with suppress(WebDriverException, pytest.fail.Exception):
            self.driver.quit()
        self._browser.close()


class _Browser:
    """A connection to the developer tools of the whole browser, which a driver can't reach."""

    def __init__(self, address: str) -> None:
        """Connect. Raises OSError or WebSocketException."""
        self._socket = websocket.create_connection(address, timeout=HANG, suppress_origin=True)
        self._number = 0

    def ask(self, method: str, **fields: Any) -> dict[str, Any]:
        self._number += 1
        try:
            self._socket.send(json.dumps({"id": self._number, "method": method, "params": fields}))
            while (answer := json.loads(self._socket.recv())).get("id") != self._number:
                pass
        except (OSError, ValueError, websocket.WebSocketException):
            pytest.fail(ENDED, pytrace=False)
        assert "result" in answer, answer
        return dict(answer["result"])

    def close(self) -> None:
        with suppress(OSError, websocket.WebSocketException):
            self._socket.close()


def _connected() -> tuple[_Browser, int]:
    """Connect to the run's Chromium, or to its successor if it has crashed; return the connection and the port."""
    found: list[tuple[_Browser, int]] = []

    def connected() -> bool:
        chromium = given("chromium")
        with suppress(OSError, websocket.WebSocketException):
            found.append((_Browser(chromium["address"]), chromium["port"]))
        return bool(found)

    until(connected, HANG)
    return found[0]


class _Driver(Remote):
    """A driver that fails the test once Chromium has ended, since no page can appear any more."""

    def execute(self, driver_command: str, params: dict[str, Any] | None = None) -> dict[str, Any]:
        try:
            return super().execute(driver_command, params)
        except InvalidSessionIdException:
            pytest.fail(ENDED, pytrace=False)


class _Chromedriver:
    """The program between selenium and Chromium: one for all sessions of this process, begun when first needed."""

    process: Guarded[bytes] | None = None
    port = 0

    @classmethod
    def url(cls) -> str:
        if cls.process is None or cls.process.poll() is not None:
            with socket.create_server(("127.0.0.1", 0)) as server:
                cls.port = int(server.getsockname()[1])
            line = [program("chromedriver", "chromium-driver"), f"--port={cls.port}"]
            cls.process = Guarded(line, stdout=DEVNULL, stderr=DEVNULL)
            until(cls._listens, HANG)
        return f"http://127.0.0.1:{cls.port}"

    @classmethod
    def _listens(cls) -> bool:
        with suppress(OSError), socket.create_connection(("127.0.0.1", cls.port), 1):
            return True
        return False


def _attached(options: ChromeOptions) -> Remote:
    """Start a session of the driver; retry, since it attaches to any open page, which another worker may close."""
    url, made = _Chromedriver.url(), list[Remote]()

    def attached() -> bool:
        with suppress(WebDriverException):
            made.append(_Driver(url, options=options, client_config=ClientConfig(url, timeout=2 * HANG)))
        return bool(made)

    until(attached, HANG)
    return made[0]
