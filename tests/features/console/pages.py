"""A page's client: it requests data, sends commands and receives server-sent events, over real connections."""

import http.client
import json
import threading
from contextlib import suppress
from pathlib import Path
from typing import Any, NamedTuple
from urllib.parse import urlsplit

from lumen.features.console.serving import Console
from lumen.run.reaching import Reached, reach_exhibition
from tests.waiting import HANG

JSON = {"Content-Type": "application/json"}


class Answer(NamedTuple):
    """An HTTP answer of the console."""

    status: int
    headers: dict[str, str]
    body: bytes

    @property
    def data(self) -> Any:
        return json.loads(self.body)


class Browser:
    """A client of the console at an address."""

    def __init__(self, address: str) -> None:
        parts = urlsplit(address)
        self.host, self.port = parts.hostname or "", parts.port or 0
        self._number = 0

    def ask(self, method: str, path: str, body: bytes | None = None, **headers: str) -> Answer:
        connection = http.client.HTTPConnection(self.host, self.port, timeout=HANG)
        try:
            connection.request(method, path, body, headers={k.replace("_", "-"): v for k, v in headers.items()})
            answer = connection.getresponse()
            return Answer(answer.status, {k.lower(): v for k, v in answer.getheaders()}, answer.read())
        finally:
            connection.close()

    def get(self, path: str, **headers: str) -> Answer:
        return self.ask("GET", path, **headers)

    def post(self, path: str, data: Any, **headers: str) -> Answer:
        return self.ask("POST", path, json.dumps(data).encode(), **{**JSON, **headers})

    def command(self, command: str, **fields: Any) -> Answer:
        """Send a command under an id of its own, unless `fields` have one."""
        self._number += 1
        return self.post("/api/commands", {"id": f"test-{id(self)}-{self._number}", "command": command, **fields})

    @property
    def robots(self) -> list[Any]:
        return list(self.get("/api/now").data["robots"])


class Event(NamedTuple):
    """A server-sent event."""

    kind: str
    id: str
    data: Any


class Stream:
    """Receives server-sent events on a thread; `events` are those received so far."""

    def __init__(self, browser: Browser, path: str = "/api/events", **headers: str) -> None:
        self._connection = http.client.HTTPConnection(browser.host, browser.port, timeout=HANG)
        self._connection.request("GET", path, headers={k.replace("_", "-"): v for k, v in headers.items()})
        self._answer = self._connection.getresponse()
        self.status = self._answer.status
        self.events: list[Event] = []
        self.comments = 0
        self.ended = threading.Event()
        self._socket = self._connection.sock
        self._thread = threading.Thread(target=self._read)
        self._thread.start()

    def of(self, kind: str) -> list[Event]:
        return [event for event in self.events if event.kind == kind]

    def positions(self) -> list[str]:
        return [event.id for event in self.of("entry")]

    def close(self) -> None:
        with suppress(OSError):
            if self._socket:
                self._socket.shutdown(2)
        self._thread.join(HANG)
        self._connection.close()

    def __enter__(self) -> "Stream":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _read(self) -> None:
        lines: dict[str, str] = {}
        with suppress(OSError, ValueError, http.client.HTTPException):
            while line := self._answer.readline():
                text = line.decode().rstrip("\n")
                if not text and "data" in lines:
                    self.events.append(Event(lines.get("event", ""), lines.get("id", ""), json.loads(lines["data"])))
                if not text:
                    lines = {}
                elif text.startswith(":"):
                    self.comments += 1
                else:
                    name, _, value = text.partition(": ")
                    lines[name] = value
        self.ended.set()


class Served:
    """A console that serves on a thread."""

    def __init__(self, project: Path, port: int = 0, *, bus: str | None = None, **more: Any) -> None:
        def reach() -> Reached:
            return reach_exhibition(str(project), bus)

        self.console = Console(reach, project, "127.0.0.1", port, **more)
        self.browser = Browser(self.console.address)
        self._thread = threading.Thread(target=self.console.run)
        self._thread.start()

    @property
    def serves(self) -> bool:
        """Whether the console's thread still runs."""
        return self._thread.is_alive()

    def close(self) -> None:
        self.console.end()
        self._thread.join(HANG)
        assert not self._thread.is_alive()
