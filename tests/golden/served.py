"""A console as a program that looks on sees it: an exhibition and its console as processes, and requests over HTTP."""

import json
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from http.client import HTTPConnection, HTTPException
from pathlib import Path
from typing import Any, NamedTuple, Self

from tests import ROOT
from tests.golden.warm import environment
from tests.guarded import DEVNULL, Guarded
from tests.rabbitmq import _free_ports
from tests.waiting import HANG, until

JSON = {"Content-Type": "application/json"}


class Answer(NamedTuple):
    status: int
    headers: dict[str, str]
    body: bytes

    @property
    def data(self) -> Any:
        return json.loads(self.body)


class Served:
    """An exhibition with a recording robot in real time, and its console, until closed."""

    def __init__(self, project: Path, home: Path, *options: str, pins: dict[str, str] | None = None) -> None:
        self.project, self.home = project, home
        self.log = home / "printed.txt"
        (self.port,) = _free_ports(1)
        self._number = 0
        self._environment = environment(home) | (pins or {})
        self.processes = [
            self._begin("run", project, "--robot", "recording", *options),
            self._begin("console", project, "--port", self.port),
        ]

    def __enter__(self) -> Self:
        until(lambda: any(robot["connected"] for robot in self.robots()), HANG)
        return self

    def __exit__(self, *_: object) -> None:
        for process in reversed(self.processes):
            process.terminate()
            process.wait()

    def ask(self, method: str, path: str, data: Any = None, **headers: str) -> Answer:
        """Send a request, and return the answer; `data` is its body, as JSON unless it is bytes."""
        body = data if data is None or isinstance(data, bytes) else json.dumps(data).encode()
        named = {**(JSON if body else {}), **{name.replace("_", "-"): value for name, value in headers.items()}}
        connection = HTTPConnection("127.0.0.1", self.port, timeout=HANG)
        try:
            connection.request(method, path, body, named)
            answer = connection.getresponse()
            return Answer(answer.status, {k.lower(): v for k, v in answer.getheaders()}, answer.read())
        finally:
            connection.close()

    def command(self, command: Any, **fields: Any) -> Answer:
        """Send a command under an id of its own, and wait until it is over."""
        self._number += 1
        return self.ask("POST", "/api/commands", {"id": f"golden-{self._number}", "command": command, **fields})

    def robots(self) -> list[Any]:
        for process in self.processes:
            assert process.poll() is None, f"a process ended:\n{self.log.read_text()}"
        with suppress(OSError, HTTPException):
            return list(self.ask("GET", "/api/now").data["robots"])
        return []

    def settled(self, condition: Callable[[dict[str, Any]], object]) -> dict[str, Any]:
        """Return the first state after this call that fulfils the condition, and in which the robot does nothing."""
        heard: list[str] = []
        found: list[dict[str, Any]] = []

        def holds() -> bool:
            found[:] = self.robots()
            for robot in found:
                if robot["heard"] not in heard:
                    heard.append(robot["heard"])
            return len(heard) > 2 and any(_still(robot) and condition(robot) for robot in found)

        until(holds, HANG, every=0.05)
        return found[0]

    @contextmanager
    def listening(self, path: str) -> Iterator[list[tuple[str, Any]]]:
        """Yield a list that receives the events of a stream as they come."""
        connection = HTTPConnection("127.0.0.1", self.port, timeout=HANG)
        connection.request("GET", path)
        answer = connection.getresponse()
        events: list[tuple[str, Any]] = []
        reader = threading.Thread(target=_read, args=(answer, events))
        reader.start()
        try:
            yield events
        finally:
            with suppress(OSError):
                connection.sock.shutdown(2)
            reader.join()
            connection.close()

    def _begin(self, *line: object) -> Guarded[bytes]:
        with self.log.open("ab") as log:
            return Guarded(
                [sys.executable, "-m", "lumen", *line],
                cwd=ROOT, stdin=DEVNULL, stdout=log, stderr=log, env=self._environment,
            )  # fmt: skip


def _still(robot: dict[str, Any]) -> bool:
    return not robot["saying"] and not robot["motion"] and not any(robot["queues"].values())


def _read(answer: Any, events: list[tuple[str, Any]]) -> None:
    with suppress(OSError, ValueError, HTTPException):
        kind = ""
        while line := answer.readline():
            name, _, value = line.decode().rstrip("\n").partition(": ")
            if name == "event":
                kind = value
            elif name == "data":
                events.append((kind, json.loads(value)))
