"""The loop that pika's connection lives in. Waiting is apart from what is done then: others may use the connection."""

import heapq
import time
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from itertools import count
from selectors import EVENT_READ, EVENT_WRITE, DefaultSelector, SelectorKey
from socket import socketpair
from typing import Any

from pika.adapters.utils.selector_ioloop_adapter import AbstractSelectorIOLoop

Events = list[tuple[SelectorKey, int]]

_numbers = count()


class PollLoop(AbstractSelectorIOLoop):  # type: ignore[misc]  # pika is not typed
    """What pika wants of a loop, turned from outside: `wait`, then `call`."""

    READ, WRITE, ERROR = EVENT_READ, EVENT_WRITE, 0  # a selector tells of an error as of both

    def __init__(self) -> None:
        self._selector = DefaultSelector()
        self._handlers: dict[int, Callable[[int, int], None]] = {}
        self._callbacks: deque[Callable[[], object]] = deque()
        self._timers: list[tuple[float, int, list[Callable[[], object]]]] = []
        self._hearing, self._waking = socketpair()
        for end in (self._hearing, self._waking):
            end.setblocking(False)
        self.add_handler(self._hearing.fileno(), self._heard, EVENT_READ)

    def wait(self, seconds: float) -> Events:
        """What happens within so many seconds, or is there to be called; without changing anything."""
        if self._callbacks:
            seconds = 0.0
        elif self._timers:
            seconds = min(seconds, max(0.0, self._timers[0][0] - time.monotonic()))
        return self._selector.select(seconds)

    def call(self, events: Events) -> None:
        """Do what is to be done about these events, what other threads asked for, and what is due."""
        for key, mask in events:
            if handler := self._handlers.get(key.fd):
                handler(key.fd, mask)
        for _ in range(len(self._callbacks)):
            self._callbacks.popleft()()
        now = time.monotonic()
        while self._timers and self._timers[0][0] <= now:
            for work in heapq.heappop(self._timers)[2]:
                work()

    def add_callback(self, callback: Callable[[], object]) -> None:
        """From any thread: call this, and let `wait` return."""
        self._callbacks.append(callback)
        with suppress(OSError):  # full, as after many: it is awake; or closed
            self._waking.send(b"x")

    def call_later(self, delay: float, callback: Callable[[], object]) -> Any:
        timer = [callback]
        heapq.heappush(self._timers, (time.monotonic() + delay, next(_numbers), timer))
        return timer

    def remove_timeout(self, timeout_handle: list[Callable[[], object]]) -> None:
        """It is called no more; its time wakes nobody."""
        timeout_handle.clear()
        while self._timers and not self._timers[0][2]:
            heapq.heappop(self._timers)

    def add_handler(self, fd: int, handler: Callable[[int, int], None], events: int) -> None:
        self._handlers[fd] = handler
        self._selector.register(fd, events)

    def update_handler(self, fd: int, events: int) -> None:
        self._selector.modify(fd, events)

    def remove_handler(self, fd: int) -> None:
        del self._handlers[fd]
        self._selector.unregister(fd)

    def close(self) -> None:
        self._selector.close()
        self._hearing.close()
        self._waking.close()

    def _heard(self, fd: int, events: int) -> None:
        with suppress(BlockingIOError):
            self._hearing.recv(4096)
