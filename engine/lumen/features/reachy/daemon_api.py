"""Calls Reachy Mini's daemon over HTTP: in a queue on a separate thread, or directly on the caller's."""

import http.client
import json
import logging
import re
import uuid
from collections.abc import Callable
from queue import SimpleQueue
from threading import Event
from typing import Any
from urllib.parse import urlsplit

from lumen.errors import RobotError, RobotFailedError, RobotLostError, UsageError
from lumen.upkeep.threads import WatchedThread

PORT = 8000
PATIENCE = 5.0
"""The default time limit for the daemon's answer [s]."""
UPLOAD_PATIENCE = 15.0

_log = logging.getLogger(__name__)


class DaemonAddress:
    """The address of a daemon. Raises UsageError if `url` is not an HTTP address, or has a path."""

    def __init__(self, url: str) -> None:
        try:
            parts = urlsplit(url if "://" in url else f"http://{url}")
            host, port = parts.hostname, parts.port or PORT
        except ValueError:
            host, port, parts = None, 0, urlsplit("")
        if not host or parts.scheme != "http" or parts.path not in ("", "/") or re.search(r"\s", url):
            raise UsageError(f"`{url}` is no address of a daemon: write it as http://reachy-mini.local:{PORT}")
        self.host, self.port = host, port
        self.authority = f"[{host}]:{port}" if ":" in host else f"{host}:{port}"

    def __str__(self) -> str:
        return f"http://{self.authority}"


class DaemonCall:
    """A call to the daemon, possibly still in progress."""

    def __init__(self, work: Callable[[], Any]) -> None:
        self._work, self._over = work, Event()
        self._answer: Any = None
        self._error: RobotError | None = None

    @property
    def done(self) -> bool:
        return self._over.is_set()

    def run(self) -> None:
        """Make the call on this thread, and store its answer or error."""
        try:
            self._answer = self._work()
        except RobotError as error:
            self._error = error
        except Exception as error:  # a thread that waits for the call must not wait for ever
            _log.exception("a call of the robot's daemon failed")
            self._error = RobotFailedError(f"the call failed: {error!r}")
        finally:
            self._over.set()

    def result(self) -> Any:
        """Return the answer; None if the call is not done. Raises RobotError if it failed."""
        if self._error:
            raise self._error
        return self._answer


class DaemonApi:
    """A client of the daemon at an address."""

    def __init__(self, address: DaemonAddress) -> None:
        self.address = address
        self._calls: SimpleQueue[DaemonCall | None] = SimpleQueue()
        self._thread = WatchedThread("lumen-reachy-calls", self._serve)

    def post(self, path: str, body: Any = None) -> DaemonCall:
        """Queue a POST behind all earlier calls; return the call."""
        return self.later(lambda: self.request("POST", path, body))

    def get(self, path: str) -> DaemonCall:
        """Queue a GET; return the call."""
        return self.later(lambda: self.request("GET", path))

    def later(self, work: Callable[[], Any]) -> DaemonCall:
        """Queue a function that waits for the daemon; return it as a call."""
        call = DaemonCall(work)
        if not self._thread.started:
            self._thread.start()
        self._calls.put(call)
        return call

    def request(self, method: str, path: str, body: Any = None, patience: float = PATIENCE) -> Any:
        """Make a request on this thread; return the answer's JSON data, None if the answer is empty.

        It waits at most `patience` [s]. Raises RobotLostError if the daemon does not answer, RobotFailedError if it
        refuses the request or its answer is not JSON.
        """
        content = None if body is None else json.dumps(body).encode()
        return self._request(method, path, content, {"Content-Type": "application/json"} if content else {}, patience)

    def upload(self, name: str, wav: bytes) -> None:
        """Store a WAV file on the robot as `name`. Raises RobotError if the daemon does not answer or accept it."""
        mark = uuid.uuid4().hex
        head = f'--{mark}\r\nContent-Disposition: form-data; name="file"; filename="{name}"\r\n'
        content = head.encode() + b"Content-Type: audio/wav\r\n\r\n" + wav + f"\r\n--{mark}--\r\n".encode()
        kind = {"Content-Type": f"multipart/form-data; boundary={mark}"}
        self._request("POST", "/api/media/sounds/upload", content, kind, UPLOAD_PATIENCE)

    def close(self) -> None:
        if self._thread.started:
            self._calls.put(None)
            self._thread.join(2.0)

    def _serve(self) -> None:
        while (call := self._calls.get()) is not None:
            call.run()

    def _request(self, method: str, path: str, content: bytes | None, headers: dict[str, str], patience: float) -> Any:
        connection = http.client.HTTPConnection(self.address.host, self.address.port, timeout=patience)
        try:
            connection.request(method, path, content, headers)
            answer = connection.getresponse()
            text = answer.read()
        except (OSError, http.client.HTTPException) as error:
            raise RobotLostError(f"the daemon at {self.address} does not answer: {error}") from error
        finally:
            connection.close()
        if answer.status >= 400:
            raise RobotFailedError(f"the daemon refused {path}: {answer.status} {_detail(text)}")
        try:
            return json.loads(text) if text else None
        except ValueError as error:
            raise RobotFailedError(f"what answers at {self.address} is no daemon of a Reachy Mini") from error


def _detail(text: bytes) -> str:
    """Return at most 100 characters of the daemon's reason for a refusal, or of its answer if it gives no reason."""
    try:
        data = json.loads(text)
    except ValueError:
        return text.decode("utf-8", "replace")[:100]
    return str(data.get("detail") if isinstance(data, dict) else data)[:100]
