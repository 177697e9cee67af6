"""The receiving connection: a queue for every subscription, and callbacks that only enqueue."""

import logging
from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import Any

from pika.exceptions import AMQPChannelError, ConsumerCancelled

from lumen.bus.bodies import MAX_BODY_BYTES, MAX_KEY_BYTES
from lumen.errors import BusRefusedError
from lumen.features.rabbitmq.broker import BrokerAddress
from lumen.features.rabbitmq.connection import BrokerConnection, OutageLog
from lumen.features.rabbitmq.declarer import QueueDeclarer
from lumen.features.rabbitmq.intake import Intake
from lumen.features.rabbitmq.properties import MessageProperties
from lumen.features.rabbitmq.queues import UNROUTED, queue_of
from lumen.features.rabbitmq.subscriptions import Delivery, Subscription, Subscriptions
from lumen.features.rabbitmq.wire import MessageReader
from lumen.language.routes import Route
from lumen.ports import MessageHandler
from lumen.upkeep.drops import DropLog

PREFETCH = 64
"""The maximum number of unacknowledged deliveries for each subscription."""
BIND_TIMEOUT = 5.0
"""The time limit for the broker's confirmation of a subscription [s]."""
TURN_TIME = 1.0
"""The longest wait for events in one turn of the connection [s]."""
FLOOD_PAUSE = 0.02
"""The pause before the next read in a flood of messages [s], which lets one read return many of them."""
UNBOUND_READ_TIME = 2.0
"""The time for which an unbound queue is still read, to receive its remaining messages [s]."""

_log = logging.getLogger(__name__)


class Consumer(BrokerConnection):
    """Passes deliveries within their route's rate to `receive`, and excess ones that must arrive to `refused`.

    Neither function may block. The broker sends at most `PREFETCH` unacknowledged messages for each subscription and
    stores a bounded number more, which limits the memory on both sides. `handled` acknowledges deliveries.
    """

    def __init__(
        self,
        address: BrokerAddress,
        name: str,
        outage: OutageLog,
        receive: Callable[[Delivery], None],
        refused: Callable[[Delivery, str], None],
    ) -> None:
        super().__init__(address, name, outage)
        self.intake = Intake(receive, refused, lambda seconds, work: self.connection.call_later(seconds, work))
        self._subscriptions = Subscriptions()
        self._declarer = QueueDeclarer()
        self._hurried = False
        self._epoch = 0
        self._acknowledged = 0
        self.unreadable = DropLog(_log, "properties of messages")

    def begin(self) -> None:
        """Set the prefetch limit and bind all subscriptions again."""
        self._epoch += 1
        self._acknowledged = 0
        self.intake.forget()
        self.channel.add_on_cancel_callback(self._cancelled)
        self.channel.basic_qos(prefetch_count=PREFETCH)
        for subscription in self._subscriptions.all():
            self._bind(subscription)

    def serve(self) -> bool:
        """Process events for a turn; return False after `end` is called."""
        self.process(TURN_TIME)
        self.unreadable.tell()
        self.intake.drops.tell()
        if self.intake.flooded:  # one read costs as much as handling many messages, so let messages gather
            self.intake.flooded = False
            self.ending.wait(FLOOD_PAUSE)
        return not self.ending.is_set()

    def subscriptions(self) -> list[Subscription]:
        """Return the subscriptions with a handler, in the order subscribed."""
        return self._subscriptions.active()

    def add(self, pattern: str, handler: MessageHandler, route: Route | None = None) -> Subscription:
        """Subscribe; wait up to BIND_TIMEOUT until the queue is bound, except while the broker is away.

        Raises BusRefusedError if the broker refuses. After any call of `prepare`, `add` never waits: a prepared queue
        is already bound, other queues are bound when the broker answers, and refusals are only logged.
        """
        if prepared := self._subscriptions.claim(pattern, handler):
            self._later(lambda: self._consume(prepared))
            return prepared
        subscription = self._subscriptions.add(pattern, handler, route)
        if not self._later(lambda: self._bind(subscription)) and self._epoch:
            subscription.bound.set()
            _log.warning("Lumen subscribes to `%s` as soon as the broker at %s is back", pattern, self.address)
        if not self._hurried:
            self._await(subscription)
        return subscription

    def prepare(self, routes: Mapping[str, Route]) -> None:
        """Bind queues that store these keys' messages until a handler subscribes; drop prepared queues of other keys.

        Raises BusRefusedError if the broker refuses a queue.
        """
        self._hurried = True
        waiting, dropped = self._subscriptions.prepare(routes)
        for subscription in dropped:
            subscription.active = False
            self._later(lambda s=subscription: self._drop(s))  # type: ignore[misc]
        for subscription in waiting:
            if not subscription.bound.is_set():
                self._later(lambda s=subscription: self._bind(s))  # type: ignore[misc]
                self._await(subscription)

    def watch(self, unrouted: Callable[[str], None]) -> None:
        """Call `unrouted` with the key of each message that the broker reports as having no receiver."""
        subscription = self._subscriptions.add("#", lambda message: unrouted(message.key), None, UNROUTED)
        self._later(lambda: self._bind(subscription))

    def carry(self, routes: Mapping[str, Route]) -> None:
        """Apply these routes; if a route needs a different queue, bind that before unbinding the old queue."""
        for subscription in self.subscriptions():
            old, new = subscription.route, routes.get(subscription.pattern)
            subscription.route = new
            if queue_of("", old).name != queue_of("", new).name:
                self._later(lambda s=subscription, r=old: self._move(s, r))  # type: ignore[misc]

    def remove(self, subscription: Subscription) -> None:
        """Remove a subscription; its handler gets no further messages, and its queue is removed if unused."""
        if self._subscriptions.remove(subscription):
            self._later(lambda: self._drop(subscription))

    def _await(self, subscription: Subscription) -> None:
        if not subscription.bound.wait(BIND_TIMEOUT):
            _log.warning(
                "the broker at %s does not confirm the subscription to `%s`", self.address, subscription.pattern
            )
        if subscription.refusal:
            what = f"refuses the subscription to `{subscription.pattern}`"
            raise BusRefusedError(f"the broker at {self.address} {what}: {subscription.refusal}")

    def handled(self, delivery: Delivery) -> None:
        """Acknowledge a delivery and all earlier ones, which lets the broker send more.

        Deliveries that may be lost are acknowledged only in batches of half of PREFETCH.
        """
        enough = 1 if delivery.subscription.must_arrive else PREFETCH // 2
        if delivery.epoch == self._epoch and delivery.number - self._acknowledged >= enough:
            self._acknowledged = delivery.number
            self._later(lambda: self._acknowledge(delivery))

    def end(self, timeout: float) -> bool:
        """Stop receiving and end the thread; return whether it ended within `timeout` [s]."""
        self.ending.set()
        self._later(lambda: None)
        return self.join(timeout)

    def _later(self, work: Callable[[], None]) -> bool:
        """Let the connection's thread run `work`; return False if there is no connection."""
        connection = self.connection
        if connection is None:
            return False
        connection.later(work)
        return True

    def _bind(self, subscription: Subscription) -> None:
        """Bind a subscription's queue; if the connection is lost meanwhile, the next connection binds the queue."""
        if not subscription.active or self.channel is None or subscription.epoch == self._epoch:
            return
        queue = queue_of(subscription.pattern, subscription.route, subscription.number, subscription.exchange)
        subscription.queue, refusal = self._declarer.declare(self.connection, queue)
        if refusal:
            self._refused(subscription, refusal)
        else:
            subscription.epoch = self._epoch
            if subscription.handler is not None:
                self._consume(subscription)
        subscription.bound.set()

    def _refused(self, subscription: Subscription, reason: str) -> None:
        self._subscriptions.refuse(subscription, reason)
        if self._hurried and subscription.handler is not None:
            _log.error(
                "the broker at %s refuses the subscription to `%s`: %s", self.address, subscription.pattern, reason
            )

    def _consume(self, subscription: Subscription) -> None:
        if self.channel is not None and subscription.active and subscription.epoch == self._epoch:
            subscription.tag = self.connection.consume(subscription.queue, self._reader(subscription))
            if subscription.must_arrive:
                self._declarer.bind_again(self.connection, subscription)

    def _move(self, subscription: Subscription, old: Route | None) -> None:
        if self.channel is None or not subscription.active:
            return
        unbound = Subscription(subscription.pattern, None, old, queue=subscription.queue, tag=subscription.tag)
        subscription.epoch = 0
        self._bind(subscription)
        self._declarer.unbind(self.connection, unbound)
        self.connection.call_later(UNBOUND_READ_TIME, lambda: self._later(lambda: self._drop(unbound)))

    def _drop(self, subscription: Subscription) -> None:
        """Stop reading a queue; remove it from the broker unless another subscription or process uses it."""
        if self.channel is None or not subscription.queue:
            return
        self.connection.cancel(subscription.tag)
        if any(other.queue == subscription.queue for other in self.subscriptions()):
            return
        self._declarer.remove(self.connection, subscription)

    def _cancelled(self, frame: Any) -> None:
        """Reconnect: the broker ended a subscription, for example because its queue was deleted."""
        self.connection.fail(ConsumerCancelled(frame.method.consumer_tag))

    def _acknowledge(self, delivery: Delivery) -> None:
        if delivery.epoch == self._epoch and self.channel is not None:
            with suppress(AMQPChannelError):  # the next turn raises it
                self.channel.basic_ack(delivery.number, multiple=True)

    def _reader(self, subscription: Subscription) -> MessageReader:
        def arrived(number: int, again: bool, key: bytes, properties: MessageProperties, body: bytes) -> None:
            kept = body if len(body) <= MAX_BODY_BYTES else body[: MAX_BODY_BYTES + 1]
            name = self._readable(key, properties)
            subscription.received += 1
            at = self.connection.clock.arrival()
            self.intake.take(Delivery(subscription, name, kept, properties, number, self._epoch, again, at))

        return arrived

    def _readable(self, key: bytes, properties: MessageProperties) -> str:
        """Return the key as text; count and log properties that can't be read."""
        try:
            text = key.decode()
        except UnicodeDecodeError:
            text = _short(key.decode(errors="backslashreplace"))
        if properties.unreadable:
            self.unreadable.add(
                text, f"{', '.join(properties.unreadable)} cannot be read; the message is accepted without it"
            )
        return text


def _short(key: str) -> str:
    """Return the key, cut to AMQP's limit MAX_KEY_BYTES."""
    return key.encode()[:MAX_KEY_BYTES].decode(errors="ignore")
