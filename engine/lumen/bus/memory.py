"""The embedded bus: topics without a broker or a thread.

`publish` appends to a queue and, unless a delivery is under way, delivers until the queue is empty. So messages reach
their subscribers in the order published, one at a time, from any publisher, also from a handler; in a program with one
thread everything is delivered when the outermost `publish` returns.

The queue is bounded, as in a broker: if it is full, the oldest message is dropped. The newest has the present state,
and a `rest` must not be refused because of a flood before it.
"""

import logging
import threading
from collections import deque
from collections.abc import Callable, Mapping
from functools import lru_cache
from threading import get_ident
from time import time
from typing import Any
from weakref import WeakValueDictionary

from lumen.bus.bodies import check_key, check_subscription, copied
from lumen.bus.identities import new_id
from lumen.errors import BusClosedError, Refused
from lumen.language.routes import Route
from lumen.ports import Bus, Message, MessageHandler, Outgoing
from lumen.upkeep.drops import DropLog

# A pattern matches keys as in an AMQP 0-9-1 topic exchange: keys and patterns are words separated by dots;
# in a pattern `*` matches exactly one word and `#` any number of them. An empty key has no words.


@lru_cache(maxsize=16_384)
def matches(pattern: str, key: str) -> bool:
    """Return whether a key matches a subscription's pattern; cached for each pair."""
    return _match(_words(pattern), _words(key))


@lru_cache(maxsize=4_096)
def _words(text: str) -> tuple[str, ...]:
    return tuple(text.split(".")) if text else ()


def _match(pattern: tuple[str, ...], key: tuple[str, ...]) -> bool:
    """Compare word by word; after a mismatch the last `#` takes one word more. At most |pattern| x |key| steps."""
    p = k = taken = 0
    hash_at = -1
    while k < len(key):
        if p < len(pattern) and pattern[p] == "#":
            hash_at, taken, p = p, k, p + 1
        elif p < len(pattern) and pattern[p] in ("*", key[k]):
            p, k = p + 1, k + 1
        elif hash_at >= 0:
            taken += 1
            p, k = hash_at + 1, taken
        else:
            return False
    return all(word == "#" for word in pattern[p:])


HANDLER_TIMEOUT = 5.0
"""Longest wait of closing for a subscriber that is still working [s]."""
MAX_CACHED_KEYS = 4_096
"""The number of keys whose listeners are cached; at that number the cache is cleared."""
MAX_QUEUED_MESSAGES = 100_000
"""The number of messages that may wait for subscribers; one more drops the oldest."""

_log = logging.getLogger(__name__)

_new = tuple.__new__  # half the cost of Message(…)


class _Subscription:
    __slots__ = ("active", "handler", "pattern")

    def __init__(self, pattern: str, handler: MessageHandler) -> None:
        self.pattern, self.handler = pattern, handler
        self.active = True


_Delivery = tuple[tuple[_Subscription, ...], Message]


class _Hub:
    """The state that all handles on one bus share."""

    def __init__(self) -> None:
        self.subscriptions: tuple[_Subscription, ...] = ()
        self.listeners: dict[str, tuple[_Subscription, ...]] = {}
        self.queue: deque[_Delivery | Callable[[], None]] = deque()
        self.delivering = threading.Lock()
        self.deliverer = 0
        self.drops = DropLog(_log)
        self.changing = threading.Lock()

    def change(self, *, add: _Subscription | None = None, drop: tuple[_Subscription, ...] = ()) -> None:
        with self.changing:
            kept = tuple(s for s in self.subscriptions if s not in drop)
            self.subscriptions = (*kept, add) if add else kept
            self.listeners = {}

    def find(self, key: str) -> tuple[_Subscription, ...]:
        """Return the subscriptions that match a key, in order, and cache them until subscriptions change."""
        check_key(key)
        with self.changing:
            if len(self.listeners) >= MAX_CACHED_KEYS:
                self.listeners = {}
            found = tuple(s for s in self.subscriptions if matches(s.pattern, key))
            self.listeners[key] = found
            return found

    def shed(self) -> None:
        """Drop the oldest messages; a waiting `close` is moved to the end of the queue."""
        with self.changing:
            while len(self.queue) > MAX_QUEUED_MESSAGES:
                item = self.queue.popleft()
                if type(item) is tuple:
                    self.drops.add(
                        item[1].key, f"{MAX_QUEUED_MESSAGES:,} messages are waiting for a subscriber already"
                    )
                else:
                    self.queue.append(item)

    def refuse(self, message: Message, reason: str) -> None:
        """Reply to a sender who wants an answer that the message could not be used."""
        if message.reply_to and (listeners := self.find(message.reply_to)):
            text = f"message refused: {reason}"
            self.queue.append(
                (listeners, Message(message.reply_to, text, "", message.correlation_id, new_id(), "", time()))
            )

    def hand_over(self, subscriptions: tuple[_Subscription, ...], message: Message) -> None:
        """Call the handlers, and reply to the sender for each that refuses."""
        last = subscriptions[-1]
        for subscription in subscriptions:
            if not subscription.active:
                continue
            try:
                own = message if subscription is last else message._replace(body=copied(message.body))
                subscription.handler(own)
            except Refused as error:
                self.refuse(message, str(error))
            except Exception:
                _log.exception("a subscriber of `%s` failed on `%s`", subscription.pattern, message.key)

    def deliver(self) -> None:
        """Empty the queue, unless another call does so already.

        That call looks at the queue again after it has released the lock, so nothing appended before is lost.
        """
        queue, delivering = self.queue, self.delivering
        while queue and delivering.acquire(False):
            try:
                self.deliverer = get_ident()
                while queue:
                    item = queue.popleft()
                    if type(item) is tuple:
                        subscriptions, message = item
                        self.hand_over(subscriptions, message)
                    else:
                        item()  # type: ignore[operator]
                if self.drops.untold:
                    self.drops.tell(all=True)
            finally:
                self.deliverer = 0
                delivering.release()


_shared: WeakValueDictionary[str, _Hub] = WeakValueDictionary()


class MemoryBus(Bus):
    """A handle on a bus inside this process: a new bus, or with a `name` the one shared by all handles of that name.

    Every subscriber gets its own copy of the body. A message reaches those who were subscribed when it was published,
    at once, so `ttl` has no effect. `sender` is the name of this program in its messages.
    """

    def __init__(self, name: str = "", sender: str = "") -> None:
        self.sender = sender
        self._hub = _shared.setdefault(name, _Hub()) if name else _Hub()
        self._mine: dict[_Subscription, None] = {}
        self._closed = False

    @property
    def dropped(self) -> Mapping[str, int]:
        """The number of dropped messages, by key."""
        return self._hub.drops.counts

    def carry(self, routes: Mapping[str, Route]) -> None:
        """Do nothing: every message arrives at once."""

    def prepare(self, routes: Mapping[str, Route]) -> None:
        """Do nothing: no preparation is needed."""

    def subscribe(self, pattern: str, handler: MessageHandler) -> Callable[[], None]:
        if self._closed:
            raise BusClosedError("the bus is closed: subscribing is no longer possible")
        check_subscription(pattern, handler)
        subscription = _Subscription(pattern, handler)
        self._mine[subscription] = None
        self._hub.change(add=subscription)

        def undo() -> None:
            subscription.active = False
            self._mine.pop(subscription, None)
            self._hub.change(drop=(subscription,))

        return undo

    def send(self, message: Outgoing) -> None:
        if self._closed:
            raise BusClosedError("the bus is closed: publishing is no longer possible")
        key, body, reply_to, correlation_id, _, id, sender, sent_at, cause = message
        own = copied(body)
        hub = self._hub
        listeners = hub.listeners.get(key)
        if listeners is None:
            listeners = hub.find(key)
        if listeners:
            sender, sent_at = sender or self.sender, sent_at or time()  # as `origin_of` gives it
            own_message = (key, own, reply_to, correlation_id, id or new_id(), sender, sent_at, cause)
            hub.queue.append((listeners, _new(Message, own_message)))
            if len(hub.queue) > MAX_QUEUED_MESSAGES:
                hub.shed()
            hub.deliver()

    def heard(self, key: str) -> bool:
        """Return whether a subscription matches this key."""
        return bool(self._hub.find(key))

    def reply(self, message: Message, body: Any) -> None:
        if message.reply_to:
            self.publish(message.reply_to, body, correlation_id=message.correlation_id)

    def close(self) -> None:
        """Deliver what was published, then cancel this handle's subscriptions; other handles stay open.

        Wait at most HANDLER_TIMEOUT for a subscriber that is still working on another thread.
        """
        if self._closed:
            return
        self._closed = True
        gone = threading.Event()
        self._hub.queue.append(lambda: self._leave(gone))
        self._hub.deliver()
        if self._hub.deliverer != get_ident() and not gone.wait(HANDLER_TIMEOUT):
            _log.warning("a subscriber was still working %g s after the bus was closed", HANDLER_TIMEOUT)

    def _leave(self, gone: threading.Event) -> None:
        mine = tuple(self._mine)
        self._mine.clear()
        for subscription in mine:
            subscription.active = False
        self._hub.change(drop=mine)
        gone.set()


def open_bus(url: str, sender: str) -> MemoryBus:
    """Return the bus of `memory://NAME`, which this process shares under that name; a new one without a name."""
    return MemoryBus(url.partition("://")[2], sender)
