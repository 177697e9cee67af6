"""The bus on RabbitMQ, which runs pika's connections on separate threads.

One connection receives and one sends; a third thread runs the handlers. Heartbeats are therefore answered while a
handler works, and `publish` never waits for the network. After a lost connection, subscriptions are restored, and
unsent messages keep waiting. Stops, if a route carries any, use a separate set of connections and threads.
"""

import logging
import threading
import time
from collections import Counter
from collections.abc import Callable, Mapping
from typing import Any

from lumen.bus.bodies import JSON, check_key, check_subscription, encode
from lumen.bus.identities import origin_of
from lumen.errors import BusClosedError, BusError
from lumen.features.rabbitmq.broker import BrokerAddress
from lumen.features.rabbitmq.connection import OutageLog
from lumen.features.rabbitmq.outbox import OutgoingMessage
from lumen.features.rabbitmq.packing import packed
from lumen.features.rabbitmq.queues import EXCHANGE, MAX_LENGTH_TELEMETRY, journal_of
from lumen.features.rabbitmq.transport import Transport
from lumen.language.counts import counted
from lumen.language.routes import Carried, Direction, Route
from lumen.ports import Bus, Message, MessageHandler, Outgoing

CLOSE_TIMEOUT = 5.0
"""The time limit for closing the bus, including sending waiting messages and handling received messages [s]."""

_log = logging.getLogger(__name__)


class AmqpBus(Bus):
    """A bus on the exchange `amq.topic` of the broker at `url` (`amqp://` or `amqps://`).

    A key's route (`carry`) decides how its messages are sent. A message without a route waits in the outbox while the
    broker is away, and is sent only once; after its `ttl` it is discarded, here or on the broker. `sender` is the name
    of the program that uses the bus. Raises BusError, with the remedy, if the broker is unusable.
    """

    def __init__(self, url: str, sender: str = "") -> None:
        self.sender = sender
        self._address = BrokerAddress(url)
        self._outage = OutageLog(self._address)
        self._closed = False
        self._routes: Mapping[str, Route] = {}
        self._stop_transport: Transport | None = None
        self._watching, self._opening = False, threading.Lock()
        self._transport = Transport(self._address, self._outage)
        try:
            self._transport.open()
        except BusError:
            self._end(time.monotonic() + CLOSE_TIMEOUT)
            raise

    @property
    def host(self) -> str:
        """The broker's host."""
        return str(self._address.parameters.host)

    @property
    def away(self) -> bool:
        """Whether the broker can't be reached at present."""
        return self._outage.going_on

    @property
    def blocked(self) -> str:
        """The resource that the broker lacks while it accepts no messages; empty if it accepts them."""
        return self._outage.blocked

    @property
    def dropped(self) -> Mapping[str, int]:
        """The number of dropped messages for each key."""
        found = Counter[str]()
        for transport in self._transports():
            for drops in transport.drops:
                found.update(drops.counts)
        return found

    def carry(self, routes: Mapping[str, Route]) -> None:
        """Apply these routes to all messages, and watch for messages without a receiver."""
        self._routes = dict(routes)
        self._open_stop(routes)
        if not self._watching:
            self._watching = True
            self._transport.consumer.watch(self._transport.publisher.unrouted)
        out = [k for k, r in routes.items() if r.carried is Carried.JOURNAL and r.direction is Direction.OUT]
        self._transport.publisher.journals = {key: journal_of(key) for key in out}
        for transport in self._transports():
            transport.publisher.known = tuple(routes)
            transport.consumer.carry(routes)

    def prepare(self, routes: Mapping[str, Route]) -> None:
        """Bind the queues of incoming routes, to store messages until a handler subscribes.

        Raises BusError if the broker refuses a queue.
        """
        self._open_stop(routes)
        for transport in self._transports():
            coming = {
                k: r for k, r in routes.items() if r.direction is Direction.IN and self._transport_of(r) is transport
            }
            transport.consumer.prepare(coming)

    def subscribe(self, pattern: str, handler: MessageHandler) -> Callable[[], None]:
        """Call the handler with each message that matches the pattern; return a function that unsubscribes it.

        Raises BusError if the bus is closed, the pattern is invalid, or the broker refuses the subscription.
        """
        if self._closed:
            raise BusClosedError("the bus is closed: subscribing is no longer possible")
        check_subscription(pattern, handler)
        route = self._routes.get(pattern)
        consumer = self._transport_of(route).consumer
        subscription = consumer.add(pattern, handler, route)
        return lambda: consumer.remove(subscription)

    def send(self, message: Outgoing) -> None:
        """Queue a message for sending. Raises BusError if the bus is closed or full, or a key or body is invalid."""
        if self._closed:
            raise BusClosedError("the bus is closed: publishing is no longer possible")
        key, body, reply_to, correlation_id, ttl, *_ = message
        for name in (key, reply_to, correlation_id):
            check_key(name)
        route = self._routes.get(key)
        form = packed(body, route.content_type) if route and route.content_type != JSON else None
        data = form.data if form else encode(body)
        keep, must = 0, False
        if route is not None:
            ttl = route.lifetime if ttl is None else ttl
            must = route.must_arrive
            keep = 0 if must else route.keep or MAX_LENGTH_TELEMETRY
        deadline = None if ttl is None else time.monotonic() + ttl
        self._transport_of(route).publisher.outbox.put(
            OutgoingMessage(
                EXCHANGE,
                key,
                data,
                form.content_type if form else JSON,
                reply_to,
                correlation_id,
                deadline,
                keep=keep,
                must=must,
                origin=origin_of(message, self.sender),
                headers=form.headers if form else None,
            )
        )

    def heard(self, key: str) -> bool:
        """Return whether a process receives messages under this key; True if unknown."""
        return self._transport_of(self._routes.get(key)).publisher.heard(key)

    def returns(self, handler: Callable[[str], None]) -> None:
        """Call the handler with the key of each message that has no receiver."""
        for transport in self._transports():
            transport.publisher.returned = handler

    def reply(self, message: Message, body: Any) -> None:
        """Reply to a message, unless it expects no reply.

        A text for a queue is sent unchanged, because modules from 2015 expect `command finished`; every other body is
        sent as JSON. Raises BusError if the bus is closed, the reply queue's name is invalid, or the body isn't JSON.
        """
        if not message.reply_to:
            return
        if self._closed:
            raise BusClosedError("the bus is closed: publishing is no longer possible")
        check_key(message.reply_to)
        self._transport.answer(message.reply_to, message.correlation_id, body, self.sender)

    def close(self) -> None:
        """Deliver published messages, including those to our own subscribers, within CLOSE_TIMEOUT; then end."""
        if self._closed:
            return
        self._closed = True
        deadline = time.monotonic() + CLOSE_TIMEOUT
        for transport in self._transports():
            transport.close(deadline)
        self._end(deadline)

    def _open_stop(self, routes: Mapping[str, Route]) -> None:
        """Start to open a separate transport for stops if a route carries any, without waiting for the connection."""
        with self._opening:
            if self._stop_transport is None and any(route.carried is Carried.STOP for route in routes.values()):
                self._stop_transport = Transport(self._address, self._outage, "stop-")
                self._stop_transport.begin()

    def _transports(self) -> list[Transport]:
        return [self._transport, *([self._stop_transport] if self._stop_transport else [])]

    def _transport_of(self, route: Route | None) -> Transport:
        return (
            self._stop_transport
            if self._stop_transport and route and route.carried is Carried.STOP
            else self._transport
        )

    def _end(self, deadline: float) -> None:
        self._closed = True
        ended = [transport.end(deadline) for transport in self._transports()]
        if left := sum(len(transport.publisher.outbox) for transport in self._transports()):
            _log.warning("the bus was closed before %s could be sent", counted(left, "message"))
        elif not all(ended):
            _log.warning("the bus was still working %g s after it was closed", CLOSE_TIMEOUT)
