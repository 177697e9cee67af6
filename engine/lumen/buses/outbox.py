"""What waits to be sent: bounded, so that a broker that is away does not fill the memory."""

import threading
import time
from collections import deque
from collections.abc import Callable, Iterable
from typing import NamedTuple

from lumen.errors import BusError

CAPACITY = 50_000
BYTES = 64 * 1024 * 1024
MUST = 10_000
"""Messages that must arrive and wait: beyond it, who sends another is told."""


class OutgoingMessage(NamedTuple):
    """A message on its way out; after `deadline` [s, monotonic] nobody wants it any more.

    Of those with the same key at most `keep` wait, the newest (0: all). One with an `id` must arrive: it is sent until
    the broker has it, and who receives it twice knows it by its id. `headers` travel with it.
    """

    exchange: str
    key: str
    body: bytes
    content_type: str
    reply_to: str = ""
    correlation_id: str = ""
    deadline: float | None = None
    type: str = ""
    keep: int = 0
    id: str = ""
    headers: dict[str, str] | None = None

    @property
    def expiration(self) -> str | None:
        """What is left to live, as AMQP has it: a text in [ms]."""
        return None if self.deadline is None else str(max(1, round(1000 * (self.deadline - time.monotonic()))))


class Outbox:
    """Any thread puts, one thread takes, first what must arrive.

    When it is full the oldest gives way and is counted in `dropped`; what must arrive never does: `put` raises BusError
    instead. `late` are those whose deadline passed before they could be sent. `awaken` is called where somebody may be
    asleep who wants to know that there is something again.
    """

    def __init__(self, awaken: Callable[[], None] = lambda: None) -> None:
        self.dropped = self.late = 0
        self._awaken = awaken
        self._must: deque[OutgoingMessage] = deque()
        self._may: deque[OutgoingMessage | str] = deque()
        self._newest: dict[str, deque[OutgoingMessage]] = {}
        self._bytes = {True: 0, False: 0}
        self._changed = threading.Condition()
        self._asleep = False

    def put(self, parcel: OutgoingMessage) -> None:
        with self._changed:
            if parcel.id:
                self._check_room(parcel)
                self._must.append(parcel)
            elif parcel.keep:
                self._replace(parcel)
            else:
                self._may.append(parcel)
            self._weigh(parcel, +1)
            while len(self._may) > CAPACITY or self._bytes[False] > BYTES:
                self._pop()
                self.dropped += 1
            asleep, self._asleep = self._asleep, False
            self._changed.notify_all()
        if asleep:
            self._awaken()

    def take(self, most: int, timeout: float) -> list[OutgoingMessage]:
        """The next parcels still wanted, at most so many; none if there is nothing within `timeout` [s]."""
        with self._changed:
            if timeout and not self:
                self._changed.wait(timeout)
            now = time.monotonic()
            taken: list[OutgoingMessage] = []
            while self and len(taken) < most:
                parcel = self._pop()
                if parcel.deadline is None or parcel.deadline > now:
                    taken.append(parcel)
                else:
                    self.late += 1
            if not self:
                self._changed.notify_all()
            return taken

    def put_back(self, parcels: Iterable[OutgoingMessage]) -> None:
        """These could not be sent: they are the next again. What newer ones have replaced meanwhile is forgotten."""
        with self._changed:
            for parcel in reversed(list(parcels)):
                if parcel.id:
                    self._must.appendleft(parcel)
                elif parcel.keep and len(self._newest.get(parcel.key, ())) >= parcel.keep:
                    continue
                elif parcel.keep:
                    self._newest.setdefault(parcel.key, deque()).appendleft(parcel)
                    self._may.appendleft(parcel.key)
                else:
                    self._may.appendleft(parcel)
                self._weigh(parcel, +1)

    def sleep(self) -> bool:
        """Whether there is nothing: then `awaken` is called at the next `put`."""
        with self._changed:
            self._asleep = not self
            return self._asleep

    def emptied(self, timeout: float) -> bool:
        """Wait until everything has been taken; whether it has, within `timeout` [s]."""
        with self._changed:
            return self._changed.wait_for(lambda: not self, timeout)

    def wake(self) -> None:
        """Let who waits in `take` look around."""
        with self._changed:
            self._changed.notify_all()
        self._awaken()

    def __len__(self) -> int:
        return len(self._must) + len(self._may)

    def _replace(self, parcel: OutgoingMessage) -> None:
        """The newest of a key take the places of the oldest."""
        waiting = self._newest.setdefault(parcel.key, deque())
        waiting.append(parcel)
        self._may.append(parcel.key)
        while len(waiting) > parcel.keep:
            self._weigh(waiting.popleft(), -1)
            self._may.remove(parcel.key)

    def _check_room(self, parcel: OutgoingMessage) -> None:
        if len(self._must) < MUST and self._bytes[True] + len(parcel.body) <= BYTES:
            return
        now = time.monotonic()
        late = [p for p in self._must if p.deadline is not None and p.deadline <= now]
        if not late:
            raise BusError(f"the broker takes nothing, and {len(self._must):,} messages that must arrive wait already")
        self.late += len(late)
        self._must = deque(p for p in self._must if p.deadline is None or p.deadline > now)
        self._bytes[True] = sum(len(p.body) for p in self._must)

    def _weigh(self, parcel: OutgoingMessage, sign: int) -> None:
        self._bytes[bool(parcel.id)] += sign * len(parcel.body)

    def _pop(self) -> OutgoingMessage:
        parcel = self._must.popleft() if self._must else self._next()
        self._weigh(parcel, -1)
        return parcel

    def _next(self) -> OutgoingMessage:
        item = self._may.popleft()
        if not isinstance(item, str):
            return item
        waiting = self._newest[item]
        parcel = waiting.popleft()
        if not waiting:
            del self._newest[item]
        return parcel
