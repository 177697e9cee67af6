"""What waits to be sent: bounded, so that a broker that is away does not fill the memory."""

import threading
import time
from collections import deque
from typing import NamedTuple

CAPACITY = 50_000
BYTES = 64 * 1024 * 1024


class Parcel(NamedTuple):
    """A message on its way out; after `deadline` [s, monotonic] nobody wants it any more."""

    exchange: str
    key: str
    body: bytes
    content_type: str
    reply_to: str = ""
    correlation_id: str = ""
    deadline: float | None = None
    type: str = ""

    @property
    def expiration(self) -> str | None:
        """What is left to live, as AMQP has it: a text in [ms]."""
        return None if self.deadline is None else str(max(1, round(1000 * (self.deadline - time.monotonic()))))


class Outbox:
    """Any thread puts, one thread takes; when full, the oldest gives way and is counted in `dropped`."""

    def __init__(self) -> None:
        self.dropped = 0
        self._parcels: deque[Parcel] = deque()
        self._bytes = 0
        self._changed = threading.Condition()

    def put(self, parcel: Parcel) -> None:
        with self._changed:
            self._parcels.append(parcel)
            self._bytes += len(parcel.body)
            while len(self._parcels) > CAPACITY or self._bytes > BYTES:
                self._pop()
                self.dropped += 1
            self._changed.notify_all()

    def take(self, most: int, timeout: float) -> list[Parcel]:
        """The next parcels still wanted, at most so many; none if there is nothing within `timeout` [s]."""
        with self._changed:
            if not self._parcels:
                self._changed.wait(timeout)
            now = time.monotonic()
            taken = [self._pop() for _ in range(min(most, len(self._parcels)))]
            if not self._parcels:
                self._changed.notify_all()
            return [p for p in taken if p.deadline is None or p.deadline > now]

    def put_back(self, parcels: list[Parcel]) -> None:
        """These could not be sent: they are the next again."""
        with self._changed:
            self._parcels.extendleft(reversed(parcels))
            self._bytes += sum(len(p.body) for p in parcels)

    def emptied(self, timeout: float) -> bool:
        """Wait until everything has been taken; whether it has, within `timeout` [s]."""
        with self._changed:
            return self._changed.wait_for(lambda: not self._parcels, timeout)

    def wake(self) -> None:
        """Let who waits in `take` look around."""
        with self._changed:
            self._changed.notify_all()

    def __len__(self) -> int:
        return len(self._parcels)

    def _pop(self) -> Parcel:
        parcel = self._parcels.popleft()
        self._bytes -= len(parcel.body)
        return parcel
