"""A bounded queue of messages to be sent, which limits memory use while the broker is away."""

import logging
import threading
import time
from collections import deque
from collections.abc import Callable, Iterable, Mapping
from typing import NamedTuple

from lumen.errors import BusFullError
from lumen.language.causes import UNKNOWN_ORIGIN, MessageOrigin
from lumen.upkeep.drops import DropLog

MAX_PENDING_MESSAGES = 50_000
"""The maximum number of waiting messages that may be lost; beyond it, the oldest are dropped."""
MAX_PENDING_BYTES = 64 * 1024 * 1024
"""The maximum total size of waiting bodies [bytes], separately for messages that must arrive and those that may be
lost.
"""
MAX_PENDING_RELIABLE = 10_000
"""The maximum number of waiting messages that must arrive; beyond it, `put` raises BusFullError."""
LATE = "they were too old before they could be sent"

_log = logging.getLogger(__name__)


class OutgoingMessage(NamedTuple):
    """A message to be sent."""

    exchange: str
    key: str
    body: bytes
    content_type: str
    reply_to: str = ""
    correlation_id: str = ""
    deadline: float | None = None
    """The time after which the message is discarded [s, monotonic]; None for never."""
    type: str = ""
    """AMQP's `type` of the message; empty for none."""
    keep: int = 0
    """The maximum number of the key's newest messages that wait; 0 for any number."""
    must: bool = False
    """Whether the message is resent until the broker confirms it; receivers recognise repetitions by its id."""
    origin: MessageOrigin = UNKNOWN_ORIGIN
    headers: Mapping[str, str | int] | None = None
    """The message's AMQP headers; None for none."""

    @property
    def expiration(self) -> str | None:
        """The remaining time to live [ms] as AMQP's text, at least `1`; None without a deadline."""
        return None if self.deadline is None else str(max(1, round(1000 * (self.deadline - time.monotonic()))))


class Outbox:
    """A queue that any thread can fill and empty; messages that must arrive are sent first.

    When it is full, the oldest messages that may be lost are dropped, and `put` raises BusFullError for a message that
    must arrive. `drops` counts dropped and expired messages by key. `came` is called after each new message.
    """

    def __init__(self, came: Callable[[], None] = lambda: None) -> None:
        self.drops = DropLog(_log)
        self._received = came
        self._must: deque[OutgoingMessage] = deque()
        self._may: deque[OutgoingMessage | str] = deque()
        self._newest: dict[str, deque[OutgoingMessage]] = {}
        self._bytes = {True: 0, False: 0}
        self._changed = threading.Condition()

    def put(self, message: OutgoingMessage) -> None:
        """Add a message. Raises BusFullError if it must arrive and the queue is full."""
        with self._changed:
            if message.must:
                self._check_room(message)
                self._must.append(message)
            elif message.keep:
                self._replace(message)
            else:
                self._may.append(message)
            self._weigh(message, +1)
            while len(self._may) > MAX_PENDING_MESSAGES or self._bytes[False] > MAX_PENDING_BYTES:
                self.drops.add(self._pop().key, "too many messages are waiting to be sent")
        self._received()

    def take(self, limit: int) -> list[OutgoingMessage]:
        """Remove and return at most `limit` unexpired messages in sending order; drop expired ones before them."""
        with self._changed:
            now = time.monotonic()
            taken: list[OutgoingMessage] = []
            while (self._must or self._may) and len(taken) < limit:
                message = self._pop()
                if message.deadline is None or message.deadline > now:
                    taken.append(message)
                else:
                    self.drops.add(message.key, LATE)
            if not self:
                self._changed.notify_all()
            return taken

    def put_back(self, messages: Iterable[OutgoingMessage]) -> None:
        """Put unsent messages back in front; discard those that newer messages have replaced."""
        with self._changed:
            for message in reversed(list(messages)):
                if message.must:
                    self._must.appendleft(message)
                elif message.keep and len(self._newest.get(message.key, ())) >= message.keep:
                    continue
                elif message.keep:
                    self._newest.setdefault(message.key, deque()).appendleft(message)
                    self._may.appendleft(message.key)
                else:
                    self._may.appendleft(message)
                self._weigh(message, +1)

    def emptied(self, timeout: float) -> bool:
        """Wait until the outbox is empty; return whether that happened within `timeout` [s]."""
        with self._changed:
            return self._changed.wait_for(lambda: not self, timeout)

    def __len__(self) -> int:
        return len(self._must) + len(self._may)

    def _replace(self, message: OutgoingMessage) -> None:
        """Add the message, and remove its key's oldest messages beyond `keep`."""
        waiting = self._newest.setdefault(message.key, deque())
        waiting.append(message)
        self._may.append(message.key)
        while len(waiting) > message.keep:
            self._weigh(waiting.popleft(), -1)
            self._may.remove(message.key)

    def _check_room(self, new: OutgoingMessage) -> None:
        if len(self._must) < MAX_PENDING_RELIABLE and self._bytes[True] + len(new.body) <= MAX_PENDING_BYTES:
            return
        now = time.monotonic()
        late = [p for p in self._must if p.deadline is not None and p.deadline <= now]
        if not late:
            raise BusFullError(
                "the broker accepts no messages, and the queue of messages that must arrive is full"
                f" ({len(self._must):,})"
            )
        for message in late:
            self.drops.add(message.key, LATE)
        self._must = deque(p for p in self._must if p.deadline is None or p.deadline > now)
        self._bytes[True] = sum(len(p.body) for p in self._must)

    def _weigh(self, message: OutgoingMessage, sign: int) -> None:
        self._bytes[message.must] += sign * len(message.body)

    def _pop(self) -> OutgoingMessage:
        message = self._must.popleft() if self._must else self._next()
        self._weigh(message, -1)
        return message

    def _next(self) -> OutgoingMessage:
        item = self._may.popleft()
        if not isinstance(item, str):
            return item
        waiting = self._newest[item]
        message = waiting.popleft()
        if not waiting:
            del self._newest[item]
        return message
