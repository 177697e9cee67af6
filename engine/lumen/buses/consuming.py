"""The connection that receives: a queue of its own for every subscription, and nothing but enqueueing in callbacks."""

import logging
import threading
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from pika.exceptions import AMQPError, ChannelClosedByBroker, ConsumerCancelled

from lumen.buses.addresses import Address
from lumen.buses.bodies import MAX_BYTES
from lumen.buses.links import Link
from lumen.errors import BusError
from lumen.ports import Handler

EXCHANGE = "amq.topic"
PREFETCH = 64
WAITING = 20_000
PATIENCE = 5.0

_log = logging.getLogger(__name__)


@dataclass(eq=False)
class Subscription:
    """A pattern, its handler, and its queue on the broker; `bound` is set once the broker has answered."""

    pattern: str
    handler: Handler
    active: bool = True
    queue: str = ""
    tag: str = ""
    refusal: str = ""
    epoch: int = 0
    bound: threading.Event = field(default_factory=threading.Event)


class Delivery(NamedTuple):
    """A message as it came, for the thread that runs handlers; `number` and `epoch` say what to acknowledge."""

    subscription: Subscription
    key: str
    body: bytes
    properties: Any
    number: int
    epoch: int


class Consuming(Link):
    """Hands every delivery to `receive`, which must not block.

    The broker sends `PREFETCH` messages ahead of each subscription and keeps at most `WAITING` more, the newest: that
    bounds the memory on both sides. `handled` acknowledges.
    """

    def __init__(self, address: Address, receive: Callable[[Delivery], None]) -> None:
        super().__init__(address, "in")
        self._receive = receive
        self._subscriptions: list[Subscription] = []
        self._changing = threading.Lock()
        self._epoch = 0
        self._acknowledged = 0

    def begin(self) -> None:
        self._epoch += 1
        self._acknowledged = 0
        self.channel.add_on_cancel_callback(self._cancelled)
        self.channel.basic_qos(prefetch_count=PREFETCH)
        for subscription in self.subscriptions():
            self._bind(subscription)

    def serve(self) -> bool:
        self.process(1.0)
        return not self.ending.is_set()

    def subscriptions(self) -> list[Subscription]:
        with self._changing:
            return list(self._subscriptions)

    def add(self, pattern: str, handler: Handler) -> Subscription:
        """Subscribe; returns when the binding is in force, at once where the broker is away (it is made on its return).

        Raises BusError where the broker refuses it.
        """
        subscription = Subscription(pattern, handler)
        with self._changing:
            self._subscriptions.append(subscription)
        if not self._later(lambda: self._bind(subscription)):
            _log.warning("`%s` is subscribed to as soon as the broker at %s is back", pattern, self.address)
        elif not subscription.bound.wait(PATIENCE):
            _log.warning("the broker at %s does not confirm the subscription to `%s`", self.address, pattern)
        if subscription.refusal:
            raise BusError(f"the broker at {self.address} refuses to let us read `{pattern}`: {subscription.refusal}")
        return subscription

    def remove(self, subscription: Subscription) -> None:
        """No message reaches the handler from now on; its queue goes away with its consumer."""
        with self._changing:
            if not subscription.active:
                return
            subscription.active = False
            self._subscriptions.remove(subscription)
        self._later(lambda: self._cancel(subscription))

    def handled(self, delivery: Delivery) -> None:
        """This and all before it are done: the broker may send on."""
        if delivery.epoch == self._epoch and delivery.number - self._acknowledged >= PREFETCH // 2:
            self._acknowledged = delivery.number
            self._later(lambda: self._acknowledge(delivery))

    def end(self, timeout: float) -> bool:
        """Stop listening and end; whether that was done within `timeout` [s]."""
        self.ending.set()
        self._later(lambda: None)
        return self.join(timeout)

    def _later(self, work: Callable[[], None]) -> bool:
        """Have the link's thread do this; false where there is no connection."""
        connection = self.connection
        if connection is None:
            return False
        try:
            connection.add_callback_threadsafe(work)
        except AMQPError:
            return False
        return True

    def _bind(self, subscription: Subscription) -> None:
        if not subscription.active or self.channel is None or subscription.epoch == self._epoch:
            return
        arguments = {"x-max-length": WAITING, "x-overflow": "drop-head"}
        try:
            declared = self.channel.queue_declare("", exclusive=True, auto_delete=True, arguments=arguments)
            subscription.queue = declared.method.queue
            self.channel.queue_bind(subscription.queue, EXCHANGE, subscription.pattern)
            subscription.tag = self.channel.basic_consume(subscription.queue, self._callback(subscription))
            subscription.epoch = self._epoch
        except ChannelClosedByBroker as error:
            subscription.refusal = error.reply_text
            self.remove(subscription)
            raise
        finally:
            subscription.bound.set()

    def _cancelled(self, frame: Any) -> None:
        """The broker took a queue from us (somebody deleted it): start anew."""
        raise ConsumerCancelled(frame.method.consumer_tag)

    def _cancel(self, subscription: Subscription) -> None:
        if subscription.tag and self.channel is not None:
            self.channel.basic_cancel(subscription.tag)

    def _acknowledge(self, delivery: Delivery) -> None:
        if delivery.epoch == self._epoch and self.channel is not None:
            with suppress(ChannelClosedByBroker):
                self.channel.basic_ack(delivery.number, multiple=True)

    def _callback(self, subscription: Subscription) -> Callable[..., None]:
        def arrived(_: Any, method: Any, properties: Any, body: bytes) -> None:
            kept = body if len(body) <= MAX_BYTES else body[: MAX_BYTES + 1]
            self._receive(
                Delivery(subscription, method.routing_key, kept, properties, method.delivery_tag, self._epoch)
            )

        return arrived
