"""The fake robot's clock: it advances only when a test advances it, and ends blocking calls when they are due."""

import heapq
import threading
import time
from collections.abc import Callable
from itertools import count
from typing import Any

from tests.features.naoqi.library import qi


class Blocked:
    """A call that blocks until `end`; its caller gets a future."""

    def __init__(self, times: "Times") -> None:
        self._times, self._promise, self.over = times, qi.Promise(), False
        times.waiting += 1

    @property
    def future(self) -> Any:
        return self._promise.future()

    def end(self, value: Any = None) -> None:
        """Return from the call; harmless when repeated."""
        with self._times.lock:
            if self.over:
                return
            self.over = True
            self._times.waiting -= 1
        self._promise.setValue(value)


class Times:
    """The fake robot's time, `now` [s]; `waiting` counts the calls that block."""

    def __init__(self) -> None:
        self.now, self.waiting = 0.0, 0
        self.lock = threading.RLock()
        self._due: list[tuple[float, int, Callable[[], None]]] = []
        self._number = count()
        self._ending = threading.Event()

    def at(self, when: float, do: Callable[[], None]) -> None:
        with self.lock:
            heapq.heappush(self._due, (when, next(self._number), do))

    def block(self, seconds: float, then: Callable[[], Any] = lambda: None) -> Blocked:
        """Return a call that takes so many seconds and returns the result of `then`."""
        with self.lock:
            blocked = Blocked(self)
            self.at(self.now + seconds, lambda: None if blocked.over else blocked.end(then()))
        return blocked

    def advance(self, dt: float) -> None:
        """Let `dt` [s] pass, doing what is due on the way."""
        with self.lock:
            until = self.now + dt
            while self._due and self._due[0][0] <= until + 1e-9:
                when, _, do = heapq.heappop(self._due)
                self.now = max(self.now, when)
                do()
            self.now = until

    def run(self, rate: float = 1.0) -> None:
        """Let time pass by itself from now on, `rate` times as fast as real time."""
        last = time.monotonic()

        def live() -> None:
            nonlocal last
            while not self._ending.wait(0.005):
                now = time.monotonic()
                self.advance((now - last) * rate)
                last = now

        threading.Thread(target=live, daemon=True).start()

    def close(self) -> None:
        self._ending.set()
