"""What waits to be sent to the server: bounded, the oldest gives way."""

import threading
from collections import deque

MAX_UNSENT_BYTES = 64 * 1024 * 1024
"""Frames that wait [bytes]; then the oldest are dropped."""


class SendBuffer:
    """Any thread puts, one thread takes."""

    def __init__(self) -> None:
        self._frames: deque[bytes] = deque()
        self._bytes = 0
        self._ended = False
        self._changed = threading.Condition()

    def put(self, frame: bytes) -> None:
        with self._changed:
            self._frames.append(frame)
            self._bytes += len(frame)
            while self._bytes > MAX_UNSENT_BYTES:
                self._bytes -= len(self._frames.popleft())
            self._changed.notify_all()

    def take(self) -> list[bytes]:
        """All that waits, once there is something; nothing where it has ended before."""
        with self._changed:
            self._changed.wait_for(lambda: self._frames or self._ended)
            taken = list(self._frames)
            self._frames.clear()
            self._bytes = 0
            self._changed.notify_all()
            return taken

    def emptied(self, timeout: float) -> bool:
        """Wait until everything has been taken; whether it has, within `timeout` [s]."""
        with self._changed:
            return self._changed.wait_for(lambda: not self._frames, timeout)

    def end(self) -> None:
        """Let nobody wait for more."""
        with self._changed:
            self._ended = True
            self._changed.notify_all()
