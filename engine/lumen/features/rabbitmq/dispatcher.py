"""A separate thread that runs handlers, one at a time: a slow handler delays no heartbeat."""

import hashlib
import logging
import queue
import threading
import time
from collections.abc import Callable

from lumen.bus.bodies import JSON, decode
from lumen.bus.identities import believed
from lumen.errors import Refused
from lumen.features.rabbitmq.packing import unpacked
from lumen.features.rabbitmq.properties import header_fields
from lumen.features.rabbitmq.queues import UNROUTED
from lumen.features.rabbitmq.subscriptions import Delivery, Subscription
from lumen.language.routes import FLOATS_TYPE, JPEG_TYPE, Carried
from lumen.ports import Message
from lumen.upkeep.drops import DropLog, ReasonLog
from lumen.upkeep.threads import MessageGuard, WatchedThread

FLUSH_MARK = "lumen.mark"
"""AMQP's `type` of a mark, a message whose arrival shows that all earlier messages have arrived."""
MAX_REMEMBERED_IDS = 10_000
"""The maximum number of remembered ids, by which repetitions of messages that must arrive are recognised."""
MAX_SHOWN = 40
"""The maximum number of characters of an id or a sender in a log message."""

_log = logging.getLogger(__name__)


class Dispatcher:
    """Decodes deliveries and passes them to their handlers in the order received.

    `handled` is called with each finished delivery, `refused` with each unusable delivery and the reason. For
    telemetry, handlers receive only the route's `keep` newest messages, within its `lifetime`. A message that must
    arrive is passed on only once, even if it is delivered twice. If a sender reuses an id for a different message, that
    message is counted in `repeated` and refused.
    """

    def __init__(self, handled: Callable[[Delivery], None], refused: Callable[[Delivery, str], None]) -> None:
        self._handled, self._refused = handled, refused
        self._waiting: queue.SimpleQueue[Delivery | None] = queue.SimpleQueue()
        self._marks: set[str] = set()
        self._marked = threading.Event()
        self._done: dict[tuple[int, str, str], str] = {}
        self.repeated = DropLog(_log)
        self.unusable = ReasonLog(_log, "a message on `%(key)s` was dropped: %(reason)s")
        self.guard = MessageGuard(_log, "the message dispatcher")
        self._thread = WatchedThread("lumen-bus-handlers", self._run, vital=True)
        self._thread.start()

    def receive(self, delivery: Delivery) -> None:
        """Queue a delivery for the handlers' thread."""
        self._waiting.put(delivery)

    @property
    def inside(self) -> bool:
        """Whether the caller runs on the handlers' thread."""
        return self._thread.current

    def expect(self, marks: set[str]) -> threading.Event:
        """Return an event that is set when a message of type FLUSH_MARK has arrived for each body in `marks`."""
        self._marks = marks
        if not marks:
            self._marked.set()
        return self._marked

    def end(self, timeout: float) -> bool:
        """Handle the received deliveries, then end; return whether the thread ended within `timeout` [s].

        On the handlers' own thread, return True without waiting.
        """
        self._waiting.put(None)
        return self.inside or self._thread.join(max(0.0, timeout))

    def _run(self) -> None:
        while (delivery := self._waiting.get()) is not None:
            delivery.subscription.handled += 1
            try:
                with self.guard(delivery.key):
                    self._take(delivery.subscription, delivery)
            finally:
                self._handled(delivery)

    def _take(self, subscription: Subscription, delivery: Delivery) -> None:
        if delivery.spent:
            return
        if delivery.properties.type == FLUSH_MARK:
            self._mark_arrived(delivery.body.decode(errors="replace"))
        elif subscription.active and self._wanted(subscription, delivery):
            self._deliver(subscription, delivery)

    def _mark_arrived(self, mark: str) -> None:
        if mark in self._marks:
            self._marks.discard(mark)
            if not self._marks:
                self._marked.set()

    def _wanted(self, subscription: Subscription, delivery: Delivery) -> bool:
        """Return False if the delivery is too old, displaced by newer deliveries, or a repetition."""
        route = subscription.route
        if route is None:
            return True
        late = route.lifetime is not None and time.monotonic() - delivery.at > route.lifetime
        if route.must_arrive:
            if late:
                self._drop(delivery, f"it waited for longer than {route.lifetime:g} s")
            return not late and self._new(subscription, delivery)
        return not late and not (route.keep and subscription.taken - subscription.handled >= route.keep)

    def _new(self, subscription: Subscription, delivery: Delivery) -> bool:
        """Return whether a delivery is new, judged by its sender and id; without an id, by its whole content.

        Without an id, only a redelivery by the broker is a repetition. With a known id, the same content is a
        repetition if the broker redelivered it or it has a time. Without a time, the sender may have restarted its ids.
        Any other message with a known id is refused, except a stop, which counts as new.
        """
        id, sender = delivery.properties.message_id, delivery.properties.app_id
        digest = _digest(delivery)
        mark = (subscription.number, sender if id else "", id or digest)
        first = self._done.get(mark)
        if first is None:
            self._done[mark] = digest
            if len(self._done) > MAX_REMEMBERED_IDS:
                del self._done[next(iter(self._done))]
            return True
        if not id:
            return not delivery.again
        if first == digest and (delivery.again or delivery.properties.timestamp):
            return False
        if subscription.route and subscription.route.carried is Carried.STOP:
            return True
        self._repeat(delivery)
        return False

    def _repeat(self, delivery: Delivery) -> None:
        id, sender = delivery.properties.message_id, delivery.properties.app_id
        who = repr(sender[:MAX_SHOWN]) if sender else "a sender without a name (`app_id`)"
        reason = f"{who} has sent the id {id[:MAX_SHOWN]!r} before: give each message its own id"
        self.repeated.add(delivery.key, reason)
        self.repeated.tell()
        self._refused(delivery, reason)

    def _deliver(self, subscription: Subscription, delivery: Delivery) -> None:
        properties = delivery.properties
        if subscription.exchange == UNROUTED:
            self._hand(subscription, delivery, Message(delivery.key, None))
            return
        try:
            if (form := properties.content_type) in (JPEG_TYPE, FLOATS_TYPE):
                body = unpacked(delivery.body, form, header_fields(properties.table))
            else:
                body = decode(delivery.body, form or JSON, properties.content_encoding)
        except ValueError as error:
            self._drop(delivery, str(error))
            return
        origin = believed(properties.message_id, properties.app_id, properties.timestamp, properties.headers)
        message = Message(delivery.key, body, properties.reply_to, properties.correlation_id, *origin)
        self._hand(subscription, delivery, message)

    def _hand(self, subscription: Subscription, delivery: Delivery, message: Message) -> None:
        try:
            assert subscription.handler is not None
            subscription.handler(message)
        except Refused as error:
            self._refused(delivery, str(error))
        except Exception as error:
            _log.exception("a subscriber of `%s` failed on `%s`", subscription.pattern, delivery.key)
            if subscription.must_arrive:
                self._refused(delivery, f"its handler failed: {error!r}")

    def _drop(self, delivery: Delivery, reason: str) -> None:
        self.unusable(delivery.key, reason)
        self._refused(delivery, reason)


def _digest(delivery: Delivery) -> str:
    properties = delivery.properties
    head = f"{delivery.key} {properties.correlation_id} {properties.reply_to} {properties.timestamp} "
    return hashlib.sha256(head.encode(errors="replace") + delivery.body).hexdigest()
