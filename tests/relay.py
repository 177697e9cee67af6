"""A cable between a client and a broker, which can be cut silently, refuse connections, be slow, and be mended."""

import selectors
import socket
import threading
import time
from collections import deque
from contextlib import suppress
from typing import Any

from tests.waiting import HANG

CHUNK = 1 << 16
LOOK = 0.02


class Relay:
    """Listens on `port` of loopback and forwards to another, `delay` [s] later.

    `cut` stops that without closing anything, `mend` resumes it; `reset` loses all connections, and `refuse` those
    that come, too, until it is mended.
    """

    def __init__(self, target: int) -> None:
        self._target, self.delay = target, 0.0
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.port = int(self._listener.getsockname()[1])
        self._whole = threading.Event()
        self._whole.set()
        self._ending = self._refusing = False
        self._ends: list[socket.socket] = []
        self._thread = threading.Thread(target=self._admit, daemon=True)
        self._thread.start()
        self._threads: list[threading.Thread] = []

    def cut(self) -> None:
        self._whole.clear()

    def mend(self) -> None:
        self._refusing = False
        self._whole.set()

    def reset(self) -> None:
        ends, self._ends = self._ends, []
        for end in ends:
            with suppress(OSError):
                end.shutdown(socket.SHUT_RDWR)

    def refuse(self) -> None:
        self._refusing = True
        self.reset()

    def close(self) -> None:
        self._ending = True
        self.mend()
        with suppress(OSError):
            self._listener.shutdown(socket.SHUT_RDWR)
        self._listener.close()
        self.reset()
        for thread in (self._thread, *self._threads):
            thread.join(HANG)

    def _admit(self) -> None:
        with suppress(OSError):
            while not self._ending:
                near, _ = self._listener.accept()
                if self._refusing:
                    near.close()
                    continue
                thread = threading.Thread(target=self._connect, args=(near,), daemon=True)
                self._threads.append(thread)
                thread.start()

    def _connect(self, near: socket.socket) -> None:
        """Forward a connection; a cut cable neither connects nor refuses a client."""
        self._ends.append(near)
        with near, suppress(OSError), selectors.DefaultSelector() as selector:
            self._whole.wait()
            with socket.create_connection(("127.0.0.1", self._target)) as far:
                self._ends.append(far)
                selector.register(near, selectors.EVENT_READ, far)
                selector.register(far, selectors.EVENT_READ, near)
                self._forward(selector)

    def _forward(self, selector: selectors.BaseSelector) -> None:
        """Forward bytes until one of the ends is closed."""
        under_way: deque[tuple[float, Any, bytes]] = deque()
        while not self._ending:
            for key, _ in selector.select(LOOK if under_way else 0.5):
                self._whole.wait()
                source: Any = key.fileobj
                if not (data := source.recv(CHUNK)):
                    return
                under_way.append((time.monotonic() + self.delay, key.data, data))
            while under_way and under_way[0][0] <= time.monotonic():
                _, target, data = under_way.popleft()
                target.sendall(data)
