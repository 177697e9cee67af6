"""The connection that receives: a queue of its own for every subscription, and nothing but enqueueing in callbacks."""

import logging
import threading
import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from pika.exceptions import AMQPError, ChannelClosedByBroker, ConsumerCancelled

from lumen.buses.addresses import Address
from lumen.buses.bodies import MAX_BYTES
from lumen.buses.links import Link, Outage
from lumen.buses.queues import EXCHANGE, NOWHERE, SETTLING, Queue, queue_of
from lumen.errors import BusError
from lumen.language.routes import Route
from lumen.ports import Handler

PREFETCH = 64
PATIENCE = 5.0
TURN = 1.0
STALL = 0.5
"""By how much a turn may take longer [s] before this process counts as having stood still."""
LEAVING = 2.0
"""How long a queue that nothing comes to any more is read on [s]: what was in it has come by then."""
OTHERWISE = 406
"""The broker's code for a queue that exists and was made otherwise."""

_log = logging.getLogger(__name__)


@dataclass(eq=False)
class Subscription:
    """A pattern, its handler, and its queue on the broker; `bound` is set once the broker has answered.

    Until there is a handler (`prepared`) the queue only gathers. `received` and `handled` count the deliveries.
    """

    pattern: str
    handler: Handler | None
    route: Route | None = None
    number: int = 0
    exchange: str = EXCHANGE
    active: bool = True
    queue: str = ""
    tag: str = ""
    refusal: str = ""
    epoch: int = 0
    received: int = 0
    handled: int = 0
    bound: threading.Event = field(default_factory=threading.Event)

    @property
    def must_arrive(self) -> bool:
        return self.route is not None and self.route.must_arrive


class Delivery(NamedTuple):
    """A message as it came at `at` [s, monotonic], `again` where the broker may have sent it before.

    `number` and `epoch` say what to acknowledge.
    """

    subscription: Subscription
    key: str
    body: bytes
    properties: Any
    number: int
    epoch: int
    again: bool = False
    at: float = 0.0


class Consuming(Link):
    """Hands every delivery to `receive`, which must not block.

    The broker sends `PREFETCH` messages ahead of each subscription and keeps a bounded number more: that bounds the
    memory on both sides. `handled` acknowledges.
    """

    def __init__(self, address: Address, name: str, outage: Outage, receive: Callable[[Delivery], None]) -> None:
        super().__init__(address, name, outage)
        self._receive = receive
        self._subscriptions: list[Subscription] = []
        self._prepared: dict[str, Subscription] = {}
        self._settling: set[str] = set()
        self._changing = threading.Lock()
        self._hurried = False
        self._epoch = 0
        self._acknowledged = 0
        self._turned = self._since = time.monotonic()

    def begin(self) -> None:
        self._epoch += 1
        self._acknowledged = 0
        self.channel.add_on_cancel_callback(self._cancelled)
        self.channel.basic_qos(prefetch_count=PREFETCH)
        for subscription in [*self.subscriptions(), *self._prepared.values()]:
            self._bind(subscription)

    def serve(self) -> bool:
        now = time.monotonic()
        self._since = self._turned if now - self._turned > TURN + STALL else now
        self._turned = now
        self.process(TURN)
        return not self.ending.is_set()

    def subscriptions(self) -> list[Subscription]:
        with self._changing:
            return list(self._subscriptions)

    def add(self, pattern: str, handler: Handler, route: Route | None = None) -> Subscription:
        """Subscribe; returns when the binding is in force, at once where the broker is away (it is made on its return).

        Raises BusError where the broker refuses it. Whoever has ever prepared can't wait: what was prepared is in force
        already, the rest as soon as the broker has answered; what it refuses is logged.
        """
        if subscription := self._claimed(pattern, handler):
            return subscription
        subscription = self._subscribed(pattern, handler, route)
        if not self._hurried:
            self._await(subscription)
        return subscription

    def prepare(self, routes: Mapping[str, Route]) -> None:
        """Have queues for these keys bound, which gather until somebody subscribes; those prepared before are let go.

        Raises BusError where the broker refuses one.
        """
        self._hurried = True
        with self._changing:
            taken = {s.pattern for s in self._subscriptions}
            old, self._prepared = self._prepared, {}
            for key in routes.keys() - taken:
                self._prepared[key] = old.pop(key) if key in old else Subscription(key, None, routes[key])
            waiting = list(self._prepared.values())
        for subscription in old.values():
            subscription.active = False
            self._later(lambda s=subscription: self._drop(s))  # type: ignore[misc]
        for subscription in waiting:
            if not subscription.bound.is_set():
                self._later(lambda s=subscription: self._bind(s))  # type: ignore[misc]
                self._await(subscription)

    def watch(self, told: Callable[[str], None]) -> None:
        """Tell of the keys for which nobody waits, as far as the broker knows of them."""
        subscription = Subscription("#", lambda message: told(message.key), exchange=NOWHERE)
        with self._changing:
            self._subscriptions.append(subscription)
        self._later(lambda: self._bind(subscription))

    def carry(self, routes: Mapping[str, Route]) -> None:
        """Go on under these routes; where one of them needs another queue, that is bound before the old one is left."""
        for subscription in self.subscriptions():
            old, new = subscription.route, routes.get(subscription.pattern)
            subscription.route = new
            if queue_of("", old).name != queue_of("", new).name:
                self._later(lambda s=subscription, r=old: self._move(s, r))  # type: ignore[misc]

    def remove(self, subscription: Subscription) -> None:
        """No message reaches the handler from now on; its queue goes away."""
        with self._changing:
            if not subscription.active:
                return
            subscription.active = False
            self._subscriptions.remove(subscription)
        self._later(lambda: self._drop(subscription))

    def _claimed(self, pattern: str, handler: Handler) -> Subscription | None:
        with self._changing:
            subscription = self._prepared.pop(pattern, None)
            if subscription is None or not subscription.bound.is_set() or subscription.refusal:
                return None
            subscription.handler = handler
            self._subscriptions.append(subscription)
        self._later(lambda: self._consume(subscription))
        return subscription

    def _subscribed(self, pattern: str, handler: Handler, route: Route | None) -> Subscription:
        with self._changing:
            numbers = {s.number for s in self._subscriptions if s.pattern == pattern}
            number = next(n for n in range(len(numbers) + 1) if n not in numbers)
            subscription = Subscription(pattern, handler, route, number)
            self._subscriptions.append(subscription)
        if not self._later(lambda: self._bind(subscription)) and self._epoch:
            subscription.bound.set()
            _log.warning("`%s` is subscribed to as soon as the broker at %s is back", pattern, self.address)
        return subscription

    def _await(self, subscription: Subscription) -> None:
        if not subscription.bound.wait(PATIENCE):
            _log.warning(
                "the broker at %s does not confirm the subscription to `%s`", self.address, subscription.pattern
            )
        if subscription.refusal:
            what = f"refuses to let us read `{subscription.pattern}`"
            raise BusError(f"the broker at {self.address} {what}: {subscription.refusal}")

    def handled(self, delivery: Delivery) -> None:
        """This and all before it are done: the broker may send on."""
        enough = 1 if delivery.subscription.must_arrive else PREFETCH // 2
        if delivery.epoch == self._epoch and delivery.number - self._acknowledged >= enough:
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
        try:
            queue = queue_of(subscription.pattern, subscription.route, subscription.number, subscription.exchange)
            subscription.queue, refusal = self._make(queue)
            if refusal:
                self._refused(subscription, refusal)
                return
            subscription.epoch = self._epoch
            if subscription.handler is not None:
                self._consume(subscription)
        finally:
            subscription.bound.set()

    def _refused(self, subscription: Subscription, refusal: str) -> None:
        subscription.refusal, subscription.active = refusal, False
        if self._hurried and subscription.handler is not None:
            _log.error("the broker at %s refuses to let us read `%s`: %s", self.address, subscription.pattern, refusal)
        with self._changing:
            if subscription in self._subscriptions:
                self._subscriptions.remove(subscription)
            self._prepared.pop(subscription.pattern, None)

    def _make(self, queue: Queue) -> tuple[str, str]:
        """Declare and bind a queue on a channel of its own; its name, and why the broker refuses."""
        for attempt in self._attempts(queue):
            channel = self.connection.channel()
            try:
                name = attempt(channel, queue)
                channel.close()
                return name, ""
            except ChannelClosedByBroker as error:
                refusal = str(error.reply_text)
                if error.reply_code != OTHERWISE:
                    break
        return "", refusal

    def _attempts(self, queue: Queue) -> tuple[Callable[[Any, Queue], str], ...]:
        """One after the other, where there is a queue of that name that was made otherwise."""
        if queue.quorum:
            return self._found, self._adopt
        return (self._declare, self._renew, self._adopt) if queue.name else (self._declare,)

    def _found(self, channel: Any, queue: Queue) -> str:
        """A quorum queue, which is bound when a crash of the broker can't lose it any more.

        Where the broker was killed before that, it has no log for it and never answers for it: it is made anew.
        """
        if queue.name in self._settling:
            channel.queue_delete(queue.name)
        if not self._exists(queue.name):
            self._settling.add(queue.name)
            channel.queue_declare(queue.name, durable=True, arguments=queue.arguments)
            self.connection.sleep(SETTLING)
            self._settling.discard(queue.name)
        return self._declare(channel, queue)

    def _exists(self, name: str) -> bool:
        channel = self.connection.channel()
        try:
            channel.queue_declare(name, passive=True)
        except ChannelClosedByBroker:
            return False
        channel.close()
        return True

    def _declare(self, channel: Any, queue: Queue) -> str:
        mine = not queue.name
        arguments = queue.arguments
        made = channel.queue_declare(
            queue.name, durable=not mine, exclusive=mine, auto_delete=mine, arguments=arguments
        )
        channel.queue_bind(made.method.queue, queue.exchange, queue.key)
        return str(made.method.queue)

    def _renew(self, channel: Any, queue: Queue) -> str:
        """There is one of that name that was made otherwise: where it holds nothing, another takes its place."""
        channel.queue_delete(queue.name, if_unused=True, if_empty=True)
        return self._declare(channel, queue)

    def _adopt(self, channel: Any, queue: Queue) -> str:
        """Use the one that there is: nothing in it is lost, and it is made anew when it is empty."""
        channel.queue_bind(queue.name, EXCHANGE, queue.key)
        return queue.name

    def _consume(self, subscription: Subscription) -> None:
        if self.channel is not None and subscription.active and subscription.epoch == self._epoch:
            subscription.tag = self.channel.basic_consume(subscription.queue, self._callback(subscription))

    def _move(self, subscription: Subscription, old: Route | None) -> None:
        if self.channel is None or not subscription.active:
            return
        left = Subscription(subscription.pattern, None, old, queue=subscription.queue, tag=subscription.tag)
        subscription.epoch = 0
        self._bind(subscription)
        with suppress(ChannelClosedByBroker):
            channel = self.connection.channel()
            channel.queue_unbind(left.queue, EXCHANGE, left.pattern)
            channel.close()
        self.connection.call_later(LEAVING, lambda: self._drop(left))

    def _drop(self, subscription: Subscription) -> None:
        """Stop reading a queue; nothing of it stays on the broker but what somebody needs."""
        if self.channel is None or not subscription.queue:
            return
        if subscription.tag:
            self.channel.basic_cancel(subscription.tag)
        if any(other.queue == subscription.queue for other in self.subscriptions()):
            return
        with suppress(ChannelClosedByBroker):
            channel = self.connection.channel()
            self._unmake(channel, subscription)
            channel.close()

    def _unmake(self, channel: Any, subscription: Subscription) -> None:
        """A queue that outlives us, and that no other process reads, is bound to nothing any more.

        It is deleted if it is empty; a quorum queue can't be deleted so carefully, and stays.
        """
        name, must = subscription.queue, subscription.must_arrive
        if must:
            if channel.queue_declare(name, passive=True).method.consumer_count:
                return
            channel.queue_unbind(name, EXCHANGE, subscription.pattern)
        if not queue_of("", subscription.route).quorum and (must or not subscription.tag):
            channel.queue_delete(name, if_unused=True, if_empty=must)

    def _cancelled(self, frame: Any) -> None:
        """The broker took a queue from us (somebody deleted it): start anew."""
        raise ConsumerCancelled(frame.method.consumer_tag)

    def _acknowledge(self, delivery: Delivery) -> None:
        if delivery.epoch == self._epoch and self.channel is not None:
            with suppress(ChannelClosedByBroker):
                self.channel.basic_ack(delivery.number, multiple=True)

    def _callback(self, subscription: Subscription) -> Callable[..., None]:
        def arrived(_: Any, method: Any, properties: Any, body: bytes) -> None:
            kept = body if len(body) <= MAX_BYTES else body[: MAX_BYTES + 1]
            key, number, again = method.routing_key, method.delivery_tag, method.redelivered
            subscription.received += 1
            self._receive(Delivery(subscription, key, kept, properties, number, self._epoch, again, self._arrival()))

        return arrived

    def _arrival(self) -> float:
        """When what is received now came at the earliest [s, monotonic], where this process stood still meanwhile.

        Who wakes up in the middle of a turn may see only in the next one what came in this one.
        """
        now = time.monotonic()
        return self._since if now - self._since > TURN + STALL else now
