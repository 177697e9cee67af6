"""Access control for the eyes' window: a few browsers on this machine, with the secret address."""

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
"""The window's host: visitors' pictures are shown on this machine only."""
MAX_CONNECTIONS = 8
"""The maximum number of open connections; another connection is closed without an answer."""
REQUEST_TIMEOUT = 5.0
"""The maximum time for a request to arrive, and for a browser to read a picture [s]."""


class WindowServer(ThreadingHTTPServer):
    """Calls `serve` with each request for the complete `address`.

    The address contains a token, new at each start, which hides it from other programs and web pages. Only requests
    with the server's own `Host` are answered, which prevents DNS rebinding. Raises OSError if the port is taken.
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
        """Return the HTTP status for a refusal: 421 for a foreign host, 404 for another path; 0 for no refusal."""
        if len(hosts) != 1 or hosts[0].strip().lower() not in self._hosts:
            return 421
        token = path.removeprefix("/").removesuffix("/").encode("utf-8", "replace")
        return 0 if hmac.compare_digest(token, self._token.encode()) else 404

    def process_request(self, request: Any, client_address: Any) -> None:
        """Handle a connection in a thread, or close it if `MAX_CONNECTIONS` are open."""
        if self._free.acquire(blocking=False):
            super().process_request(request, client_address)
        else:
            self.shutdown_request(request)

    def process_request_thread(self, request: Any, client_address: Any) -> None:
        """Handle a connection, then release its slot."""
        try:
            super().process_request_thread(request, client_address)
        finally:
            self._free.release()

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Do nothing: a browser that disconnects is not an error."""


class WindowPage(BaseHTTPRequestHandler):
    """One request, which must arrive within `timeout` [s]."""

    server: WindowServer
    timeout = REQUEST_TIMEOUT

    def setup(self) -> None:
        """Start the request's timer, which closes the connection."""
        self._alarm = threading.Timer(self.timeout, self._hang_up)
        self._alarm.daemon = True
        self._alarm.start()
        super().setup()

    def finish(self) -> None:
        """Stop the timer."""
        self._alarm.cancel()
        super().finish()

    def do_GET(self) -> None:
        """Answer the request, or refuse it."""
        self._alarm.cancel()
        if refusal := self.server.refusal(self.path, self.headers.get_all("Host", [])):
            self.send_error(refusal)
        else:
            self.server.serve(self)

    def wanted(self) -> bool:
        """Return True if the browser is still connected. Raises OSError if the connection is broken."""
        said = select.select([self.connection], [], [], 0.0)[0]
        return not said or self.connection.recv(1, socket.MSG_PEEK) != b""

    def log_message(self, format: str, *arguments: Any) -> None:
        """Do nothing: requests are not logged."""

    def _hang_up(self) -> None:
        with suppress(OSError):
            self.connection.shutdown(socket.SHUT_RDWR)
