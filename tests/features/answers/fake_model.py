"""A server with `/v1/chat/completions` that answers as a test wants it, with every fault that real ones have."""

import json
import socket
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any

from tests.waiting import HANG

Reply = Callable[["Handler", dict[str, Any]], None]


class Handler(BaseHTTPRequestHandler):
    """A request, which the server's `reply` answers."""

    server: "FakeModel"

    def do_POST(self) -> None:
        body = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
        self.server.requests.append((dict(self.headers), body))
        with suppress(OSError):
            self.server.reply(self, body)

    def log_message(self, format: str, *args: Any) -> None: ...

    def begin(self, kind: str = "text/event-stream", status: int = 200) -> None:
        self.send_response(status)
        self.send_header("Content-Type", kind)
        self.end_headers()

    def delta(self, **said: Any) -> None:
        """Send a piece of the answer."""
        self.event(json.dumps({"choices": [{"index": 0, "delta": said}]}))

    def event(self, data: str) -> None:
        self.wfile.write(f"data: {data}\n\n".encode())
        self.wfile.flush()

    def done(self) -> None:
        self.event(json.dumps({"choices": [{"index": 0, "delta": {}, "finish_reason": "stop"}]}))
        self.event("[DONE]")

    def wait(self) -> None:
        """Send nothing more until the client has disconnected, or the test is over."""
        self.connection.settimeout(0.05)
        while not self.server.over.is_set():
            with suppress(TimeoutError):
                if not self.connection.recv(1):
                    return


class FakeModel(ThreadingHTTPServer):
    daemon_threads = True
    address_family = socket.AF_INET

    def __init__(self, reply: Reply) -> None:
        super().__init__(("127.0.0.1", 0), Handler)
        self.reply, self.over = reply, threading.Event()
        self.requests: list[tuple[dict[str, str], dict[str, Any]]] = []

    @property
    def url(self) -> str:
        return f"http://127.0.0.1:{self.server_port}/v1/chat/completions"


@contextmanager
def fake_model(reply: Reply) -> Iterator[FakeModel]:
    server = FakeModel(reply)
    thread = threading.Thread(target=server.serve_forever, args=(0.01,), daemon=True)
    thread.start()
    try:
        yield server
    finally:
        server.over.set()
        server.shutdown()
        server.server_close()
        thread.join(HANG)


def says(*pieces: str) -> Reply:
    """Return a reply that sends an answer in these pieces."""

    def reply(handler: Handler, _: dict[str, Any]) -> None:
        handler.begin()
        for piece in pieces:
            handler.delta(content=piece)
        handler.done()

    return reply


def calls(name: str, *arguments: Any) -> Reply:
    """Return a reply that calls a tool, with its arguments in these pieces."""

    def reply(handler: Handler, _: dict[str, Any]) -> None:
        handler.begin()
        handler.delta(tool_calls=[{"index": 0, "function": {"name": name, "arguments": ""}}])
        for piece in arguments:
            handler.delta(tool_calls=[{"index": 0, "function": {"arguments": piece}}])
        handler.done()

    return reply
