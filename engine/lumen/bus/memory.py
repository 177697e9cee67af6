"""The embedded bus: topics without a broker, without a thread, and without surprises.

`publish` appends to a queue and, where nobody is delivering yet, delivers until the queue is empty. So messages reach
their subscribers in the order published, one at a time, whoever publishes from wherever, a handler included; in a
program of one thread everything has been delivered when the outermost `publish` returns.

What waits is bounded, as in the queues of a broker: when it is full, the oldest message gives way. The newest says how
things are now, and a `rest` is not refused because of a flood before it.
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

# A pattern matches keys as an AMQP 0-9-1 topic exchange decides it: keys and patterns are words with dots between them;
# in a pattern `*` matches exactly one word and `#` any number of them. An empty key has no words.


@lru_cache(maxsize=16_384)
def matches(pattern: str, key: str) -> bool:
    """Whether a message with this key goes to who subscribed to `pattern`; remembered for each pair."""
    return _match(_words(pattern), _words(key))


@lru_cache(maxsize=4_096)
def _words(text: str) -> tuple[str, ...]:
    return tuple(text.split(".")) if text else ()


def _match(pattern: tuple[str, ...], key: tuple[str, ...]) -> bool:
    """Compare word by word; where that fails, the last `#` takes one word more. At most |pattern| x |key| steps."""
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
"""How long closing waits for a subscriber that still works [s]."""
MAX_CACHED_KEYS = 4_096
"""Keys whose listeners are remembered."""
MAX_QUEUED_MESSAGES = 100_000
"""Messages that wait for a subscriber; then the oldest give way."""

_log = logging.getLogger(__name__)

_new = tuple.__new__  # half the price of Message(…)


class _Subscription:
    __slots__ = ("active", "handler", "pattern")

    def __init__(self, pattern: str, handler: MessageHandler) -> None:
        self.pattern, self.handler = pattern, handler
        self.active = True


_Delivery = tuple[tuple[_Subscription, ...], Message]


class _Hub:
    """What all the handles on one bus share."""

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
        """Who listens to this key, in the order subscribed; remembered until somebody comes or goes."""
        check_key(key)
        with self.changing:
            if len(self.listeners) >= MAX_CACHED_KEYS:
                self.listeners = {}
            found = tuple(s for s in self.subscriptions if matches(s.pattern, key))
            self.listeners[key] = found
            return found

    def shed(self) -> None:
        """Drop the oldest messages; a `close` that waits in the queue goes on waiting, behind the newest."""
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
        """Answer a sender who wants an answer that nobody could use the message."""
        if message.reply_to and (listeners := self.find(message.reply_to)):
            text = f"message refused: {reason}"
            self.queue.append(
                (listeners, Message(message.reply_to, text, "", message.correlation_id, new_id(), "", time()))
            )

    def hand_over(self, subscriptions: tuple[_Subscription, ...], message: Message) -> None:
        """Call the handlers, and answer the sender for each that refuses."""
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
        """Empty the queue, unless somebody is at it already.

        Who is at it looks at the queue once more after giving up the lock: what was appended until then is not lost.
        """
        queue, delivering = self.queue, self.delivering
        while queue and delivering.acquire(False):
            try:
                self.deliverer = get_ident()
                while queue:
                    item = queue.popleft()
                    if type(item) is tuple:
                        self.hand_over(*item)
                    else:
                        item()  # type: ignore[operator]
                if self.drops.untold:
                    self.drops.tell(all=True)
            finally:
                self.deliverer = 0
                delivering.release()


_shared: WeakValueDictionary[str, _Hub] = WeakValueDictionary()


class MemoryBus(Bus):
    """A handle on a bus inside this process: a new one, or with a `name` the one that all handles of that name share.

    Every subscriber is handed a copy of the body of its own. A message goes to who was subscribed when it was
    published; there is no time to wait in, so `ttl` changes nothing. `sender` is the program whose handle this is.
    """

    def __init__(self, name: str = "", sender: str = "") -> None:
        self.sender = sender
        self._hub = _shared.setdefault(name, _Hub()) if name else _Hub()
        self._mine: dict[_Subscription, None] = {}
        self._closed = False

    @property
    def dropped(self) -> Mapping[str, int]:
        """How many messages were dropped under each key."""
        return self._hub.drops.counts

    def carry(self, routes: Mapping[str, Route]) -> None:
        """Nothing changes: here every message arrives, and at once."""

    def prepare(self, routes: Mapping[str, Route]) -> None:
        """There is nothing to wait for."""

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
            origin = (id or new_id(), sender or self.sender, sent_at or time(), cause)  # as `origin_of` gives it
            hub.queue.append((listeners, _new(Message, (key, own, reply_to, correlation_id, *origin))))
            if len(hub.queue) > MAX_QUEUED_MESSAGES:
                hub.shed()
            hub.deliver()

    def heard(self, key: str) -> bool:
        """Whether anybody has subscribed to what is published under this key."""
        return bool(self._hub.find(key))

    def reply(self, message: Message, body: Any) -> None:
        if message.reply_to:
            self.publish(message.reply_to, body, correlation_id=message.correlation_id)

    def close(self) -> None:
        """Deliver what was published, then let go of this handle's subscriptions; other handles live on."""
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
