"""Who may look at the eyes' window: a browser of this machine that was given its address, and few of them."""

import hmac
import secrets
import select
import socket
import threading
from collections.abc import Callable
from contextlib import suppress
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any

WINDOW_HOST = "127.0.0.1"
"""Only this machine sees who stands there."""
MAX_CONNECTIONS = 8
"""How many are open at once; a further one is closed unanswered."""
REQUEST_TIMEOUT = 5.0
"""How long a request may take until it is there, and a picture until it is taken [s]."""


class WindowServer(ThreadingHTTPServer):
    """Calls `serve` with each page that was asked for by its whole `address`.

    That holds a token, new at each start, so that no other program of the machine and no page of the web finds it; and
    only its own `Host` is answered, so that no other name can be made to mean this machine. Raises OSError where the
    port is taken.
    """

    daemon_threads = True
    block_on_close = False

    def __init__(self, port: int, serve: Callable[["WindowPage"], None]) -> None:
        super().__init__((WINDOW_HOST, port), WindowPage)
        self.serve = serve
        self._token = secrets.token_urlsafe(16)
        self._free = threading.BoundedSemaphore(MAX_CONNECTIONS)
        port = self.server_address[1]
        self._hosts = (f"{WINDOW_HOST}:{port}", f"localhost:{port}")
        self.address = f"http://{self._hosts[0]}/{self._token}/"

    def refusal(self, path: str, hosts: list[str]) -> int:
        """The status of HTTP with which a request is refused, 0 where it is answered."""
        if len(hosts) != 1 or hosts[0].strip().lower() not in self._hosts:
            return 421
        token = path.removeprefix("/").removesuffix("/").encode("utf-8", "replace")
        return 0 if hmac.compare_digest(token, self._token.encode()) else 404

    def process_request(self, request: Any, client_address: Any) -> None:
        if self._free.acquire(blocking=False):
            super().process_request(request, client_address)
        else:
            self.shutdown_request(request)

    def process_request_thread(self, request: Any, client_address: Any) -> None:
        try:
            super().process_request_thread(request, client_address)
        finally:
            self._free.release()

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Nothing: that a looker has gone is not worth a line."""


class WindowPage(BaseHTTPRequestHandler):
    """One request; it has so long to arrive, however slowly it comes."""

    server: WindowServer
    timeout = REQUEST_TIMEOUT

    def setup(self) -> None:
        self._alarm = threading.Timer(self.timeout, self._hang_up)
        self._alarm.daemon = True
        self._alarm.start()
        super().setup()

    def finish(self) -> None:
        self._alarm.cancel()
        super().finish()

    def do_GET(self) -> None:
        self._alarm.cancel()
        if refusal := self.server.refusal(self.path, self.headers.get_all("Host", [])):
            self.send_error(refusal)
        else:
            self.server.serve(self)

    def wanted(self) -> bool:
        """Whether the looker is there; raises OSError where that is sure not to be so."""
        said = select.select([self.connection], [], [], 0.0)[0]
        return not said or self.connection.recv(1, socket.MSG_PEEK) != b""

    def log_message(self, format: str, *arguments: Any) -> None:
        """Nothing: that somebody looks is not worth a line."""

    def _hang_up(self) -> None:
        with suppress(OSError):
            self.connection.shutdown(socket.SHUT_RDWR)
