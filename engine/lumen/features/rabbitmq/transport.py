"""The path of messages between a bus and its broker: two connections, and the handlers' thread."""

import time
import uuid
from typing import Any

from lumen.bus.bodies import JSON, MAX_BODY_BYTES, TEXT, encode
from lumen.bus.identities import new_id
from lumen.features.rabbitmq.broker import BrokerAddress
from lumen.features.rabbitmq.connection import OutageLog
from lumen.features.rabbitmq.consumer import Consumer
from lumen.features.rabbitmq.dispatcher import FLUSH_MARK, Dispatcher
from lumen.features.rabbitmq.outbox import OutgoingMessage
from lumen.features.rabbitmq.publisher import Publisher
from lumen.features.rabbitmq.queues import DEAD_LETTERS, EXCHANGE, MAX_LENGTH_TELEMETRY
from lumen.features.rabbitmq.subscriptions import Delivery
from lumen.language.causes import MessageOrigin
from lumen.language.routing_keys import KEY_PREFIXES
from lumen.upkeep.drops import DropLog
from lumen.upkeep.ratelimit import RateLimiter

ASIDE_RATE = 10.0
"""The maximum rate, for each key, of unusable messages put aside [1/s]; a flood leaves room for other keys."""
REPLY_LIFETIME = 30.0
"""The time for which a reply waits while the broker is away [s]."""


class Transport:
    """A sending connection, a receiving one, and a thread for the handlers; `name` is the prefix of their names."""

    def __init__(self, address: BrokerAddress, outage: OutageLog, name: str = "") -> None:
        self.publisher = Publisher(address, f"{name}out", outage)
        self.consumer = Consumer(
            address, f"{name}in", outage, lambda delivery: self.dispatcher.receive(delivery), self._refused
        )
        self._aside = RateLimiter()
        self.dispatcher = Dispatcher(self.consumer.handled, self._refused)

    @property
    def drops(self) -> tuple[DropLog, ...]:
        """The logs of dropped messages, one for each kind of loss.

        In this order, they contain messages above the rate, messages not handled because of a fault in Lumen, unusable
        messages, repeated ids, messages too old or too many to wait, and messages impossible to send.
        """
        sent = self.publisher.outbox.drops, self.publisher.unsendable
        heard = self.dispatcher.guard.drops, self.dispatcher.unusable.drops, self.dispatcher.repeated
        return self.consumer.intake.drops, *heard, *sent

    def open(self) -> None:
        """Connect. Raises BusError, with the remedy, if the broker is unusable."""
        self.consumer.open()
        self.publisher.open()

    def begin(self) -> None:
        """Start connecting, without waiting for the result."""
        self.consumer.begin_alone()
        self.publisher.begin_alone()

    def answer(self, reply_to: str, correlation_id: str, body: Any, sender: str = "") -> None:
        """Send a reply: a text to a queue is sent unchanged, as modules from 2015 expect; every other body as JSON."""
        ours = reply_to.split(".")[0] in KEY_PREFIXES and not reply_to.startswith("amq.")
        text = isinstance(body, str) and not ours
        deadline = time.monotonic() + REPLY_LIFETIME
        self.publisher.outbox.put(
            OutgoingMessage(
                EXCHANGE if ours else "",
                reply_to,
                body.encode(errors="replace") if text else encode(body),
                TEXT if text else JSON,
                correlation_id=correlation_id,
                deadline=deadline,
                origin=MessageOrigin(new_id(), sender, time.time()),
            )
        )

    def close(self, deadline: float) -> None:
        """Send waiting messages, and receive our own, until the deadline [s, monotonic].

        Do nothing if called by a handler, or while the broker is blocked.
        """
        if not self.dispatcher.inside and not self.publisher.blocked:
            self._flush(deadline)

    def end(self, deadline: float) -> bool:
        """End all threads and log the drops; return whether all threads ended by the deadline [s, monotonic]."""
        parts = (self.publisher, self.consumer, self.dispatcher)
        ended = [part.end(deadline - time.monotonic()) for part in parts]
        for drops in self.drops:
            drops.tell(all=True)
        return all(ended)

    def _refused(self, delivery: Delivery, reason: str) -> None:
        """Put an unusable message aside, within ASIDE_RATE, and reply to a sender that expects an answer."""
        properties = delivery.properties
        if self.publisher.has_side_queues and not self._aside.wait(delivery.key, ASIDE_RATE):
            headers = {"reason": reason[:1000], "key": delivery.key}
            body, kind = delivery.body[:MAX_BODY_BYTES], properties.content_type or JSON
            self.publisher.outbox.put(
                OutgoingMessage(DEAD_LETTERS, delivery.key, body, kind, headers=headers, keep=MAX_LENGTH_TELEMETRY)
            )
        if properties.reply_to:
            self.answer(properties.reply_to, properties.correlation_id or "", f"message refused: {reason}")

    def _flush(self, deadline: float) -> None:
        """Send a mark into each of our own queues, and wait until all marks and the messages before them have arrived.

        Queues that other processes may also read get no mark, because their messages are not lost.
        """
        outbox = self.publisher.outbox
        if self.publisher.connection is None and not outbox:
            return
        queues = {s.queue for s in self.consumer.subscriptions() if s.queue and not s.must_arrive}
        marks = {f"{uuid.uuid4()} {queue}": queue for queue in queues}
        marked = self.dispatcher.expect(set(marks))
        for mark, queue in marks.items():
            outbox.put(OutgoingMessage("", queue, mark.encode(), TEXT, type=FLUSH_MARK))
        marked.wait(max(0.0, deadline - time.monotonic()))
        outbox.emptied(max(0.0, deadline - time.monotonic()))
