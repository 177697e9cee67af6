"""A cable between a client and a broker that a test can cut: nothing gets through, and nobody is told."""

import selectors
import socket
import threading
from contextlib import suppress
from typing import Any

CHUNK = 1 << 16


class Relay:
    """Listens on `port` of loopback and forwards to another; `cut` stops that without closing anything."""

    def __init__(self, target: int) -> None:
        self._target = target
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.port = int(self._listener.getsockname()[1])
        self._whole = threading.Event()
        self._whole.set()
        self._ending = False
        self._ends: list[socket.socket] = []
        self._thread = threading.Thread(target=self._admit, daemon=True)
        self._thread.start()
        self._threads: list[threading.Thread] = []

    def cut(self) -> None:
        self._whole.clear()

    def mend(self) -> None:
        self._whole.set()

    def close(self) -> None:
        self._ending = True
        self._whole.set()
        for end in (self._listener, *self._ends):
            with suppress(OSError):
                end.shutdown(socket.SHUT_RDWR)
            end.close()
        for thread in (self._thread, *self._threads):
            thread.join(5)

    def _admit(self) -> None:
        with suppress(OSError):
            while not self._ending:
                near, _ = self._listener.accept()
                thread = threading.Thread(target=self._connect, args=(near,), daemon=True)
                self._threads.append(thread)
                thread.start()

    def _connect(self, near: socket.socket) -> None:
        """A cut cable connects nobody, and refuses nobody either."""
        self._ends.append(near)
        with suppress(OSError), selectors.DefaultSelector() as selector:
            self._whole.wait()
            far = socket.create_connection(("127.0.0.1", self._target))
            self._ends.append(far)
            selector.register(near, selectors.EVENT_READ, far)
            selector.register(far, selectors.EVENT_READ, near)
            while self._forward(selector):
                pass
            far.close()
        near.close()

    def _forward(self, selector: selectors.BaseSelector) -> bool:
        for key, _ in selector.select(0.5):
            self._whole.wait()
            source: Any = key.fileobj
            if not (data := source.recv(CHUNK)):
                return False
            key.data.sendall(data)
        return not self._ending
