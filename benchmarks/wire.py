"""A wire between a process and its broker that can be cut, go dead without a word, or be slow."""

import contextlib
import selectors
import socket
import threading
import time
from collections import deque
from typing import Literal

Mode = Literal["whole", "cut", "dead"]
CHUNK = 65_536


class Wire:
    """Listens on loopback at `port` and passes on to `target`; `mode` and `delay` [s] may change at any time.

    `cut`: connections are closed, and refused. `dead`: nothing comes through, and nobody is told; what was on its way
    is lost with its connections when the wire is whole again, as behind a router that was restarted.
    """

    def __init__(self, target: int) -> None:
        self.delay = 0.0
        self._mode: Mode = "whole"
        self._target = target
        self._server = socket.create_server(("127.0.0.1", 0))
        self.port: int = self._server.getsockname()[1]
        self._links: list[_Link] = []
        self._closed = False
        threading.Thread(target=self._serve, daemon=True).start()

    @property
    def mode(self) -> Mode:
        return self._mode

    @mode.setter
    def mode(self, mode: Mode) -> None:
        was, self._mode = self._mode, mode
        if mode == "cut" or was == "dead":
            for link in self._links:
                link.close()
            self._links = []

    def close(self) -> None:
        self._closed, self.mode = True, "cut"
        self._server.close()

    def _serve(self) -> None:
        with contextlib.suppress(OSError):
            while not self._closed:
                near, _ = self._server.accept()
                if self._mode == "cut":
                    near.close()
                    continue
                try:
                    far = socket.create_connection(("127.0.0.1", self._target), 2.0)
                except OSError:
                    near.close()
                    continue
                self._links.append(_Link(self, near, far))


class _Link:
    """One connection: two sockets, and what is on its way between them."""

    def __init__(self, wire: Wire, near: socket.socket, far: socket.socket) -> None:
        self._wire, self._sockets, self._open = wire, (near, far), True
        threading.Thread(target=self._carry, daemon=True).start()

    def close(self) -> None:
        self._open = False

    def _carry(self) -> None:
        near, far = self._sockets
        others = {near: far, far: near}
        waiting: deque[tuple[float, socket.socket, bytes]] = deque()
        with contextlib.suppress(OSError), selectors.DefaultSelector() as selector:
            for each in self._sockets:
                selector.register(each, selectors.EVENT_READ)
            while self._open:
                for key, _ in selector.select(0.02):
                    source = key.fileobj
                    assert isinstance(source, socket.socket)
                    data = source.recv(CHUNK)
                    if not data:
                        self._open = False
                    waiting.append((time.monotonic() + self._wire.delay, others[source], data))
                while waiting and waiting[0][0] <= time.monotonic() and self._wire.mode == "whole":
                    _, target, data = waiting.popleft()
                    target.sendall(data)
        for each in self._sockets:
            with contextlib.suppress(OSError):
                each.close()
