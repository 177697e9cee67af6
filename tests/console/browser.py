"""Debian's Chromium and its driver, which end with the process that started them."""

import shutil
import socket
from contextlib import suppress
from pathlib import Path

import pytest
from selenium.common.exceptions import WebDriverException
from selenium.webdriver import ChromeOptions, Remote

from tests.fetched import ROOT, not_provided
from tests.guarded import DEVNULL, Guarded
from tests.waiting import HANG, until

UNPACKED = ROOT / ".cache/debian/root"
"""Where scripts/packages.sh unpacks for who is not root."""


class DrivenBrowser:
    """A Chromium with these `options`, under a guarded driver; it reads the driver's pipe, and ends with it.

    The driver keeps what `logs` names: `browser` what pages complain of, `performance` what they ask for, which costs
    processor time with every message.
    """

    def __init__(self, options: ChromeOptions, *logs: str) -> None:
        program, driver = _program("usr/lib/chromium/chromium", "chromium"), _program("usr/bin/chromedriver")
        port = _free_port()
        self._process: Guarded[bytes] = Guarded([driver, f"--port={port}"], stdout=DEVNULL, stderr=DEVNULL)
        until(lambda: _listens(port), HANG)
        options.binary_location = str(program)
        options.add_argument("--remote-debugging-pipe")
        options.set_capability("goog:loggingPrefs", dict.fromkeys(logs, "ALL"))
        self.driver = Remote(f"http://127.0.0.1:{port}", options=options)

    def close(self) -> None:
        with suppress(WebDriverException):
            self.driver.quit()
        self._process.kill()
        self._process.wait()


def _program(unpacked: str, name: str = "") -> Path:
    """The program; leaves the test out where this machine has none and could not be given one."""
    found = UNPACKED / unpacked if (UNPACKED / unpacked).exists() else shutil.which(name or Path(unpacked).name)
    if found is None:
        if "chromium" in (told := not_provided()):
            pytest.skip(told)
        pytest.fail("Chromium is not installed: `make setup` installs it", pytrace=False)
    return Path(found)


def _free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as server:
        return int(server.getsockname()[1])


def _listens(port: int) -> bool:
    with suppress(OSError), socket.create_connection(("127.0.0.1", port), 1):
        return True
    return False
