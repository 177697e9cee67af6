"""The event loop of pika's connection. Waiting is separate, so other threads can use the connection meanwhile."""

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
    """The event loop that pika requires; its owner runs each turn with `wait`, then `call`."""

    READ, WRITE, ERROR = EVENT_READ, EVENT_WRITE, 0  # a selector reports an error as readable and writable

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
        """Wait for events until the next timer, at most `seconds`; return the unhandled events.

        Don't wait if a callback is pending.
        """
        if self._callbacks:
            seconds = 0.0
        elif self._timers:
            seconds = min(seconds, max(0.0, self._timers[0][0] - time.monotonic()))
        return self._selector.select(seconds)

    def call(self, events: Events) -> None:
        """Handle these events, then run pending callbacks and due timers."""
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
        """Run `callback` in the next `call`, and make `wait` return. Any thread may call this."""
        self._callbacks.append(callback)
        with suppress(OSError):  # a full socket already wakes `wait`; a closed one has no waiter
            self._waking.send(b"x")

    def call_later(self, delay: float, callback: Callable[[], object]) -> Any:
        """Run `callback` in a `call` after `delay` [s]; return the handle for `remove_timeout`."""
        timer = [callback]
        heapq.heappush(self._timers, (time.monotonic() + delay, next(_numbers), timer))
        return timer

    def remove_timeout(self, timeout_handle: list[Callable[[], object]]) -> None:
        """Cancel a timer; it no longer shortens a `wait`."""
        timeout_handle.clear()
        while self._timers and not self._timers[0][2]:
            heapq.heappop(self._timers)

    def add_handler(self, fd: int, handler: Callable[[int, int], None], events: int) -> None:
        """Call the handler when any of `events` occurs on the file descriptor."""
        self._handlers[fd] = handler
        self._selector.register(fd, events)

    def update_handler(self, fd: int, events: int) -> None:
        """Change the events to watch on a file descriptor."""
        self._selector.modify(fd, events)

    def remove_handler(self, fd: int) -> None:
        """Stop watching a file descriptor."""
        del self._handlers[fd]
        self._selector.unregister(fd)

    def close(self) -> None:
        """Run the pending callbacks, by which pika closes its sockets; close the selector and what wakes it."""
        while self._callbacks:
            self.call([])
        for each in (self._selector, self._hearing, self._waking):
            each.close()

    def _heard(self, fd: int, events: int) -> None:
        with suppress(BlockingIOError):
            self._hearing.recv(4096)
