"""The bus on RabbitMQ: pika on connections and threads of its own.

One connection receives and one sends; a third thread runs the handlers. So heartbeats are answered while a handler
works, and `publish` never waits for the network. What is lost with a connection comes back with it: subscriptions are
made again, and what waits to be sent waits on.
"""

import logging
import time
import uuid
from collections.abc import Callable
from typing import Any

from lumen.buses.addresses import Address
from lumen.buses.bodies import JSON, TEXT, check_key, encode
from lumen.buses.consuming import EXCHANGE, Consuming
from lumen.buses.dispatching import MARK, Dispatching
from lumen.buses.outbox import Parcel
from lumen.buses.publishing import Publishing
from lumen.errors import BusError
from lumen.ports import Handler, Message

CLOSING = 5.0
PREFIXES = ("avatar", "lumen")

_log = logging.getLogger(__name__)


class AmqpBus:
    """A handle on the exchange `amq.topic` of the broker at `url` (`amqp://` or `amqps://`).

    Raises BusError, saying what to do, where the broker can't be used. A message without a `ttl` waits in the outbox
    for a broker that is away; one with a `ttl` is thrown away when it is over, here or on the broker.
    """

    def __init__(self, url: str) -> None:
        address = Address(url)
        self._closed = False
        self._publishing = Publishing(address)
        self._consuming = Consuming(address, lambda delivery: self._dispatching.receive(delivery))
        self._dispatching = Dispatching(self._consuming.handled)
        try:
            self._consuming.open()
            self._publishing.open()
        except BusError:
            self._end(time.monotonic() + CLOSING)
            raise

    def subscribe(self, pattern: str, handler: Handler) -> Callable[[], None]:
        if self._closed:
            raise BusError("the bus is closed: nobody can subscribe any more")
        check_key(pattern)
        subscription = self._consuming.add(pattern, handler)
        return lambda: self._consuming.remove(subscription)

    def publish(
        self, key: str, body: Any, *, reply_to: str = "", correlation_id: str = "", ttl: float | None = None
    ) -> None:
        self._send(EXCHANGE, key, encode(body), JSON, reply_to, correlation_id, ttl)

    def reply(self, message: Message, body: Any) -> None:
        """A text goes to a queue as it is, as modules of 2015 expect `command finished`; everything else as JSON."""
        if not message.reply_to:
            return
        if message.reply_to.split(".")[0] in PREFIXES:
            self.publish(message.reply_to, body, correlation_id=message.correlation_id)
        elif isinstance(body, str):
            self._send("", message.reply_to, body.encode(), TEXT, "", message.correlation_id)
        else:
            self._send("", message.reply_to, encode(body), JSON, "", message.correlation_id)

    def close(self) -> None:
        """Deliver what was published, to our own subscribers too, within 5 s, and end."""
        if self._closed:
            return
        self._closed = True
        deadline = time.monotonic() + CLOSING
        if not self._dispatching.inside:
            self._flush(deadline)
        self._end(deadline)

    def _send(
        self,
        exchange: str,
        key: str,
        body: bytes,
        content_type: str,
        reply_to: str = "",
        correlation_id: str = "",
        ttl: float | None = None,
    ) -> None:
        if self._closed:
            raise BusError("the bus is closed: nothing can be published any more")
        for name in (key, reply_to, correlation_id):
            check_key(name)
        deadline = None if ttl is None else time.monotonic() + ttl
        self._publishing.outbox.put(Parcel(exchange, key, body, content_type, reply_to, correlation_id, deadline))

    def _flush(self, deadline: float) -> None:
        """Send a mark after everything else into each of our queues: when it has come, everything else has."""
        outbox = self._publishing.outbox
        if self._publishing.connection is None and not outbox:
            return
        queues = {s.queue for s in self._consuming.subscriptions() if s.queue}
        marks = {f"{uuid.uuid4()} {queue}": queue for queue in queues}
        marked = self._dispatching.expect(set(marks))
        for mark, queue in marks.items():
            outbox.put(Parcel("", queue, mark.encode(), TEXT, type=MARK))
        marked.wait(max(0.0, deadline - time.monotonic()))
        outbox.emptied(max(0.0, deadline - time.monotonic()))

    def _end(self, deadline: float) -> None:
        self._closed = True
        ended = [part.end(deadline - time.monotonic()) for part in (self._publishing, self._consuming)]
        ended.append(self._dispatching.end(deadline - time.monotonic()))
        if left := len(self._publishing.outbox):
            _log.warning("the bus was closed with %d messages unsent", left)
        elif not all(ended):
            _log.warning("the bus was closed while it still works, after %g s", CLOSING)
