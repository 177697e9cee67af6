"""Tests a broker's permissions and state without affecting its other users."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

import pika
from pika.exceptions import ChannelClosedByBroker

from lumen.bus.brokers import QueueStatus
from lumen.errors import BusUnreachableError
from lumen.features.rabbitmq.asked_channel import AskedChannel
from lumen.features.rabbitmq.broker import BrokerAddress
from lumen.features.rabbitmq.polled import PolledConnection
from lumen.features.rabbitmq.queues import (
    EXCHANGE,
    OTHERWISE,
    SIDE_EXCHANGE,
    SIDE_QUEUE_LIMITS,
    declared_otherwise,
    queue_of,
)
from lumen.language.routes import Route

FORGED_USER = "lumen doctor"
"""The false user name in a test message."""
ACCESS_REFUSED = 403
"""AMQP's code for a missing permission."""


class BrokerProbe:
    """A connection for tests of a broker. Raises BusError, with the remedy, if the broker is unusable."""

    def __init__(self, url: str) -> None:
        self.address = BrokerAddress(url)
        self.place, self.user = self.address.place, self.address.user
        with self._explained():
            self._connection = PolledConnection(self.address.parameters)
        server = self._connection.server
        self.product, self.version = (_text(server.get(name)) for name in ("product", "version"))
        try:
            self.address.check_version(server)
        except BusUnreachableError:
            self.close()
            raise

    def has_queue(self, name: str) -> bool:
        """Return whether the broker has a queue or stream of that name."""
        try:
            with self._asking() as channel:
                channel.queue_declare(name, passive=True)
        except ChannelClosedByBroker:
            return False
        return True

    def reading(self, key: str) -> str:
        """Return the broker's reason if this user can't receive messages under this key; empty if permitted."""
        try:
            with self._asking() as channel:
                queue = channel.queue_declare("", exclusive=True).method.queue
                channel.queue_bind(queue, EXCHANGE, key)
                channel.queue_delete(queue)
        except ChannelClosedByBroker as error:
            return str(error.reply_text)
        return ""

    def writing(self, key: str) -> str:
        """Return the broker's reason if this user can't send messages under this key; empty if permitted.

        The test message contains a false user name. The broker refuses that name only after checking the permission to
        send, so the message reaches no receiver. Raises BusUnreachableError if the broker accepts the message.
        """
        properties = pika.BasicProperties(user_id=FORGED_USER)
        try:
            with self._asking() as channel:
                channel.send(EXCHANGE, key, properties)
                channel.basic_qos(prefetch_count=1)  # the broker answers in order, so after the message
        except ChannelClosedByBroker as error:
            return str(error.reply_text) if error.reply_code == ACCESS_REFUSED else ""
        raise BusUnreachableError(f"the broker at {self.address} accepted a message in the name of `{FORGED_USER}`")

    def taking(self) -> str:
        """Send a test message; return why the broker accepts no sender's messages, or an empty string."""
        try:
            self.writing("")
        except BusUnreachableError as error:
            return str(error)
        return ""

    def served(self, key: str, route: Route) -> QueueStatus:
        """Return the numbers of messages and consumers in the queue of a route whose messages must arrive.

        Both are None if the broker has no such queue.
        """
        try:
            with self._asking() as channel:
                found = channel.queue_declare(queue_of(key, route).name, passive=True).method
        except ChannelClosedByBroker:
            return QueueStatus()
        return QueueStatus(found.message_count, found.consumer_count)

    def misdeclared(self) -> Iterator[str]:
        """Yield the faults of existing side queues and exchanges, without declaring missing ones."""
        for name, limits in SIDE_QUEUE_LIMITS.items():
            for fault in (self._misdeclared(name, limits, exchange) for exchange in (True, False)):
                if fault:
                    yield fault

    def _misdeclared(self, name: str, limits: Mapping[str, Any], exchange: bool) -> str:
        try:
            with self._asking() as channel:
                if exchange:
                    channel.exchange_declare(name, passive=True)
                    channel.exchange_declare(name, SIDE_EXCHANGE, durable=True)
                else:
                    channel.queue_declare(name, passive=True)
                    channel.queue_declare(name, durable=True, arguments=limits)
        except ChannelClosedByBroker as error:
            return declared_otherwise(error.reply_text) if error.reply_code == OTHERWISE else ""
        return ""

    def close(self) -> None:
        """Close the connection."""
        self._connection.close()

    @contextmanager
    def _asking(self) -> Iterator[AskedChannel]:
        """Open a separate channel for requests. Raises ChannelClosedByBroker for a refusal, else BusError."""
        with self._explained(), self._connection.asking() as channel:
            try:
                yield channel
            finally:
                self._check_taken()

    def _check_taken(self) -> None:
        """Raise BusUnreachableError if the broker lacks a resource; a broker can report this and still answer."""
        if what := self._connection.blocked:
            raise BusUnreachableError(self.address.short_of(what))

    @contextmanager
    def _explained(self) -> Iterator[None]:
        try:
            yield
        except ChannelClosedByBroker:  # a refusal is an answer
            raise
        except Exception as error:  # pika also raises errors that are neither AMQPError nor OSError
            raise self.address.explain(error) from error


def _text(value: object) -> str:
    return value.decode(errors="replace") if isinstance(value, bytes) else str(value or "")
