"""The bus on RabbitMQ: pika on connections and threads of its own.

One connection receives and one sends; a third thread runs the handlers. So heartbeats are answered while a handler
works, and `publish` never waits for the network. What is lost with a connection comes back with it: subscriptions are
made again, and what waits to be sent waits on. Where a route carries stops, these have all three of their own.
"""

import logging
import threading
import time
import uuid
from collections.abc import Callable, Mapping
from itertools import count
from typing import Any

from lumen.buses.bodies import JSON, MAX_BYTES, TEXT, check_key, encode
from lumen.buses.broker import BrokerAddress
from lumen.buses.connection import OutageLog
from lumen.buses.consumer import Consumer
from lumen.buses.dispatcher import MARK, Dispatcher
from lumen.buses.outbox import OutgoingMessage
from lumen.buses.publisher import Publisher
from lumen.buses.queues import DEAD, EXCHANGE, NEWEST, journal_of
from lumen.buses.subscriptions import Delivery
from lumen.errors import BusError
from lumen.language.routes import Carried, Direction, Route
from lumen.ports import Message, MessageHandler

CLOSING = 5.0
PREFIXES = ("avatar", "lumen")
ANSWERED = 30.0
"""How long an answer waits for a broker that is away [s]."""

_log = logging.getLogger(__name__)


class Transport:
    """A connection for what goes, one for what comes, and a thread for the handlers."""

    def __init__(self, address: BrokerAddress, outage: OutageLog, name: str = "") -> None:
        self.publishing = Publisher(address, f"{name}out", outage)
        self.consuming = Consumer(address, f"{name}in", outage, lambda delivery: self.dispatching.receive(delivery))
        self.dispatching = Dispatcher(self.consuming.handled, self._refused)

    def open(self) -> None:
        """Raises BusError, saying what to do, where the broker can't be used."""
        self.consuming.open()
        self.publishing.open()

    def begin(self) -> None:
        """Open as soon as may be; waits for nothing."""
        self.consuming.begin_alone()
        self.publishing.begin_alone()

    def answer(self, reply_to: str, correlation_id: str, body: Any) -> None:
        """To a key of ours, or to a queue: a text as it is, as modules of 2015 expect it; everything else as JSON."""
        ours = reply_to.split(".")[0] in PREFIXES and not reply_to.startswith("amq.")
        text = isinstance(body, str) and not ours
        deadline = time.monotonic() + ANSWERED
        self.publishing.outbox.put(
            OutgoingMessage(
                EXCHANGE if ours else "",
                reply_to,
                body.encode(errors="replace") if text else encode(body),
                TEXT if text else JSON,
                correlation_id=correlation_id,
                deadline=deadline,
            )
        )

    def close(self, deadline: float) -> None:
        """Send what waits, and hear what of our own was sent."""
        if not self.dispatching.inside:
            self._flush(deadline)

    def end(self, deadline: float) -> bool:
        """Whether all threads have ended until then [s, monotonic]."""
        parts = (self.publishing, self.consuming, self.dispatching)
        ended = [part.end(deadline - time.monotonic()) for part in parts]
        return all(ended)

    def _refused(self, delivery: Delivery, reason: str) -> None:
        """Put aside what nobody could use, and tell who wants an answer."""
        properties = delivery.properties
        if self.publishing.aside:
            headers = {"reason": reason[:1000], "key": delivery.key}
            body = delivery.body[:MAX_BYTES]
            self.publishing.outbox.put(
                OutgoingMessage(DEAD, delivery.key, body, properties.content_type or JSON, headers=headers, keep=NEWEST)
            )
        if properties.reply_to:
            self.answer(properties.reply_to, properties.correlation_id or "", f"message refused: {reason}")

    def _flush(self, deadline: float) -> None:
        """Send a mark after everything else into each of our queues: when it has come, everything else has.

        Queues that others may read too have none: what is in them is not lost.
        """
        outbox = self.publishing.outbox
        if self.publishing.connection is None and not outbox:
            return
        queues = {s.queue for s in self.consuming.subscriptions() if s.queue and not s.must_arrive}
        marks = {f"{uuid.uuid4()} {queue}": queue for queue in queues}
        marked = self.dispatching.expect(set(marks))
        for mark, queue in marks.items():
            outbox.put(OutgoingMessage("", queue, mark.encode(), TEXT, type=MARK))
        marked.wait(max(0.0, deadline - time.monotonic()))
        outbox.emptied(max(0.0, deadline - time.monotonic()))


class AmqpBus:
    """A handle on the exchange `amq.topic` of the broker at `url` (`amqp://` or `amqps://`).

    Raises BusError, saying what to do, where the broker can't be used. How a message travels is said by the route of
    its key (`carry`). One without a route waits in the outbox for a broker that is away, and is sent once; with a `ttl`
    it is thrown away when that is over, here or on the broker.
    """

    def __init__(self, url: str) -> None:
        self._address = BrokerAddress(url)
        self._outage = OutageLog(self._address)
        self._closed = False
        self._routes: Mapping[str, Route] = {}
        self._name, self._numbers = uuid.uuid4().hex[:12], count(1)
        self._stop: Transport | None = None
        self._watching, self._opening = False, threading.Lock()
        self._way = Transport(self._address, self._outage)
        try:
            self._way.open()
        except BusError:
            self._end(time.monotonic() + CLOSING)
            raise

    def carry(self, routes: Mapping[str, Route]) -> None:
        self._routes = dict(routes)
        self._open_stop(routes)
        if not self._watching:
            self._watching = True
            self._way.consuming.watch(self._way.publishing.stray)
        out = [k for k, r in routes.items() if r.carried is Carried.JOURNAL and r.direction is Direction.OUT]
        self._way.publishing.journals = {key: journal_of(key) for key in out}
        for way in self._ways():
            way.publishing.known = tuple(routes)
            way.consuming.carry(routes)

    def prepare(self, routes: Mapping[str, Route]) -> None:
        self._open_stop(routes)
        for way in self._ways():
            coming = {k: r for k, r in routes.items() if r.direction is Direction.IN and self._way_of(r) is way}
            way.consuming.prepare(coming)

    def subscribe(self, pattern: str, handler: MessageHandler) -> Callable[[], None]:
        if self._closed:
            raise BusError("the bus is closed: nobody can subscribe any more")
        check_key(pattern)
        route = self._routes.get(pattern)
        consuming = self._way_of(route).consuming
        subscription = consuming.add(pattern, handler, route)
        return lambda: consuming.remove(subscription)

    def publish(
        self, key: str, body: Any, *, reply_to: str = "", correlation_id: str = "", ttl: float | None = None
    ) -> None:
        if self._closed:
            raise BusError("the bus is closed: nothing can be published any more")
        for name in (key, reply_to, correlation_id):
            check_key(name)
        route, data = self._routes.get(key), encode(body)
        keep, id = 0, ""
        if route is not None:
            ttl = route.lifetime if ttl is None else ttl
            keep = 0 if route.must_arrive else route.keep or NEWEST
            id = f"{self._name}-{next(self._numbers)}" if route.must_arrive else ""
        deadline = None if ttl is None else time.monotonic() + ttl
        self._way_of(route).publishing.outbox.put(
            OutgoingMessage(EXCHANGE, key, data, JSON, reply_to, correlation_id, deadline, keep=keep, id=id)
        )

    def reply(self, message: Message, body: Any) -> None:
        """A text goes to a queue as it is, as modules of 2015 expect `command finished`; everything else as JSON."""
        if not message.reply_to:
            return
        if self._closed:
            raise BusError("the bus is closed: nothing can be published any more")
        check_key(message.reply_to)
        self._way.answer(message.reply_to, message.correlation_id, body)

    def close(self) -> None:
        """Deliver what was published, to our own subscribers too, within 5 s, and end."""
        if self._closed:
            return
        self._closed = True
        deadline = time.monotonic() + CLOSING
        for way in self._ways():
            way.close(deadline)
        self._end(deadline)

    def _open_stop(self, routes: Mapping[str, Route]) -> None:
        """Stops get a way of their own as soon as there are any; nobody waits for it here."""
        with self._opening:
            if self._stop is None and any(route.carried is Carried.STOP for route in routes.values()):
                self._stop = Transport(self._address, self._outage, "stop-")
                self._stop.begin()

    def _ways(self) -> list[Transport]:
        return [self._way, *([self._stop] if self._stop else [])]

    def _way_of(self, route: Route | None) -> Transport:
        return self._stop if self._stop and route and route.carried is Carried.STOP else self._way

    def _end(self, deadline: float) -> None:
        self._closed = True
        ended = [way.end(deadline) for way in self._ways()]
        if left := sum(len(way.publishing.outbox) for way in self._ways()):
            _log.warning("the bus was closed with %d messages unsent", left)
        elif not all(ended):
            _log.warning("the bus was closed while it still works, after %g s", CLOSING)
