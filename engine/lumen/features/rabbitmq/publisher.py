"""The connection that sends messages and tracks which of them the broker has confirmed."""

import logging
import time
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from pika.exceptions import AMQPChannelError, AMQPConnectionError, AMQPError, ChannelClosedByBroker

from lumen.features.rabbitmq.asked_channel import AskedChannel
from lumen.features.rabbitmq.broker import BrokerAddress
from lumen.features.rabbitmq.connection import BrokerConnection, OutageLog
from lumen.features.rabbitmq.outbox import Outbox, OutgoingMessage
from lumen.features.rabbitmq.polled import PolledConnection
from lumen.features.rabbitmq.properties import CAUSE_HEADER, write_properties
from lumen.features.rabbitmq.queues import (
    OTHERWISE,
    SIDE_QUEUES,
    UNROUTED,
    Queue,
    declare_side_queues,
    declared_otherwise,
)
from lumen.language.counts import counted
from lumen.language.diagnostics import did_you_mean
from lumen.language.routes import FLOATS_TYPE, JPEG_TYPE
from lumen.upkeep.drops import DropLog

MAX_UNCONFIRMED_MESSAGES = 1_000
"""The most messages that are sent but not confirmed yet; more wait in the outbox."""
MAX_BY_GUEST = 8
"""The most waiting messages, for example after an outage, that a thread sends along when it publishes one."""
MAX_UNCONFIRMED_BYTES = 4 * 1024 * 1024
"""The maximum total size of the bodies of messages that are sent but not confirmed yet [bytes]."""
CONFIRM_TIME = 0.01
"""The time for which the broker's confirmations accumulate while more messages are sent [s]."""
IDLE_TIME = 0.5
"""The time that the connection waits for events if there is nothing to send [s]."""
MAX_WARNED_KEYS = 1_000
"""The most keys without a receiver for which a warning is logged."""
PROBE_PERIOD = 1.0
"""The time between two attempts to find out whether a key without a receiver has one now [s]."""
PERSISTENT_DELIVERY = 2
"""AMQP's delivery mode of a message that a broker writes to its disk."""

_log = logging.getLogger(__name__)


class _Sent(NamedTuple):
    """A message that was sent, until it is confirmed."""

    size: int
    """The size of its body [bytes]."""
    again: OutgoingMessage | None
    """The message to send again if the connection is lost; None if it may be lost."""


class Publisher(BrokerConnection):
    """Sends the messages of the outbox; while the broker is away, they wait for it.

    The thread that publishes a message also sends it; the connection's own thread receives confirmations and sends
    messages that had to wait. At most `MAX_UNCONFIRMED_MESSAGES` are sent without confirmation. When the connection is
    lost, those that must arrive are sent again first. Messages without a receiver are logged with the nearest of the
    `known` keys. `journals` are the queues that keep outgoing messages until a module reads them. `returned` is called
    with each key whose message has no receiver; without it, the broker returns only messages that must arrive.
    """

    def __init__(self, address: BrokerAddress, name: str, outage: OutageLog) -> None:
        super().__init__(address, name, outage)
        self.outbox = Outbox(self._send_now)
        self.known: tuple[str, ...] = ()
        self.journals: Mapping[str, Queue] = {}
        self.returned: Callable[[str], None] | None = None
        self._declared: set[str] = set()
        self._refused: set[str] = set()
        self._window: dict[int, _Sent] = {}
        self._bytes = self._number = 0
        self._seen = 0
        self._prepared: Mapping[str, Queue] | None = None
        self._warned: set[str] = set()
        self._probed: set[str] = set()
        self._missed: dict[str, float] = {}
        self.unsendable = DropLog(_log)

    def begin(self) -> None:
        """Check the broker's version, declare the side queues and request confirmations."""
        self.address.check_version(self.connection.server)
        self._number, self._declared, self._refused = 0, set(), set()
        self._declare(SIDE_QUEUES, declare_side_queues)
        self.channel.add_on_return_callback(self._returned)
        self.connection.confirm(self._confirmed, self._nacked)

    @property
    def blocked(self) -> bool:
        """Whether the broker currently accepts no messages from this connection."""
        connection = self.connection
        return bool(connection and connection.blocked)

    @property
    def has_side_queues(self) -> bool:
        """Whether the broker let us declare the side queues for unusable messages."""
        return SIDE_QUEUES in self._declared

    def serve(self) -> bool:
        """Send waiting messages and process the broker's.

        Return False once everything is sent and the end is requested.
        """
        if self.connection.blocked:  # in the outbox a message's time to live counts; sent now, it would be used late
            self.connection.turn(IDLE_TIME)
            self.outbox.drops.tell()
            return not self.ending.is_set()
        journals = self.journals
        for key, queue in journals.items():
            self._declare(key, queue.declare)
        self._prepared = journals
        self._send_waiting()
        new, self._seen = self._number != self._seen, self._number
        paused = new and self._room() > 0 and not self.ending.is_set()
        self.connection.turn(IDLE_TIME, CONFIRM_TIME if paused else 0.0)
        self.outbox.drops.tell()
        self.unsendable.tell()
        return bool(self.outbox or self._window) or not self.ending.is_set()

    def disconnect(self, connection: PolledConnection) -> None:
        """Put unconfirmed messages that must arrive back into the outbox, and close the connection."""
        self._prepared = None
        lost, self._window, self._bytes = self._window, {}, 0
        self.outbox.put_back([sent.again for sent in lost.values() if sent.again])
        connection.close()

    def end(self, timeout: float) -> bool:
        """Send the rest and end; return whether that was done within `timeout` [s]."""
        self.ending.set()
        if connection := self.connection:
            connection.wake()
        return self.join(timeout)

    def _send_now(self) -> None:
        """Send in the caller's thread; if the connection is in use, let its own thread send."""
        connection = self.connection
        if connection and not connection.lend(self._send_as_guest):
            connection.wake()

    def _send_as_guest(self) -> bool:
        """Send a few waiting messages; return False if the connection's own thread must continue."""
        if self._prepared is not self.journals:
            return False
        try:
            self._send_waiting(MAX_BY_GUEST)
        except AMQPError:
            return False
        return not self.outbox or self._room() <= 0

    def _send_waiting(self, most: int = MAX_UNCONFIRMED_MESSAGES) -> None:
        room = min(most, self._room())
        messages = self.outbox.take(room) if room > 0 else []
        for sent, message in enumerate(messages):
            try:
                self._send(message)
            except BaseException:
                self.outbox.put_back(messages[sent:])
                raise

    def _room(self) -> int:
        full = self._bytes > MAX_UNCONFIRMED_BYTES or self.connection.blocked
        return 0 if full else MAX_UNCONFIRMED_MESSAGES - len(self._window)

    def _send(self, message: OutgoingMessage) -> None:
        id, sender, sent, cause = message.origin
        said = {
            "content_type": message.content_type,
            "content_encoding": "" if message.content_type in (JPEG_TYPE, FLOATS_TYPE) else "utf-8",
            "reply_to": message.reply_to,
            "correlation_id": message.correlation_id,
            "expiration": message.expiration,
            "type": message.type,
            "message_id": id,
            "app_id": sender,
            "timestamp": int(sent),
            "delivery_mode": message.must and PERSISTENT_DELIVERY,
            "headers": {**({CAUSE_HEADER: cause} if cause else {}), **(message.headers or {})},
        }
        try:
            wanted = bool(message.must or (self.returned and message.exchange) or message.key in self._probed)
            properties = write_properties(said)
            self.connection.publish(message.exchange, message.key, properties, message.body, mandatory=wanted)
        except (AMQPChannelError, AMQPConnectionError, OSError):
            raise
        except Exception as error:  # AMQP can't carry it; sent again, it would end the connection again
            self.unsendable.add(message.key, f"AMQP cannot carry it: {error!r}")
            return
        self._number += 1
        self._window[self._number] = _Sent(len(message.body), message if message.must else None)
        self._bytes += len(message.body)

    def _confirmed(self, number: int, several: bool) -> None:
        """Record that the broker has this message, and with `several` all before it."""
        self._settled(number, several)

    def _nacked(self, number: int, several: bool) -> None:
        messages = self._settled(number, several)
        _log.warning("the broker at %s did not accept %s", self.address, counted(len(messages), "message"))
        self.outbox.put_back([sent.again for sent in messages if sent.again])

    def _settled(self, number: int, several: bool) -> list[_Sent]:
        """Remove the messages that the broker has answered for from the window, and return them."""
        first = next(iter(self._window), 0) if several else number
        messages = [sent for n in range(first, number + 1) if (sent := self._window.pop(n, None))]
        self._bytes -= sum(sent.size for sent in messages)
        return messages

    def _returned(self, _: Any, method: Any, properties: Any, body: bytes) -> None:
        """Handle a message without a receiver.

        One that must arrive goes to the side queue, so that operators can find it.
        """
        key = method.routing_key
        if method.exchange == UNROUTED:
            return
        self._miss(key)
        if self.returned:
            self.returned(key)
        if properties.delivery_mode != PERSISTENT_DELIVERY:
            return
        self.warn_once(key)
        if self.has_side_queues:
            headers = {"reason": f"no process receives `{key}`"}
            self.outbox.put(OutgoingMessage(UNROUTED, key, body, properties.content_type or "", headers=headers))

    def heard(self, key: str) -> bool:
        """Return whether a process receives messages under this key, as seen within the last PROBE_PERIOD.

        Return True if that is unknown: the next message then finds out.
        """
        self._probed.add(key)
        return time.monotonic() - self._missed.get(key, -PROBE_PERIOD) >= PROBE_PERIOD

    def _miss(self, key: str) -> None:
        if key in self._probed:
            self._missed[key] = time.monotonic()

    def unrouted(self, key: str) -> None:
        """Record that a message under this key had no receiver; log it if no route has the key."""
        self._miss(key)
        if key not in self.known:
            self.warn_once(key)

    def warn_once(self, key: str) -> None:
        """Log, once per key, that no process receives messages under it."""
        if key in self._warned or len(self._warned) >= MAX_WARNED_KEYS:
            return
        self._warned.add(key)
        others = [other for other in self.known if other != key]
        hint = f": {did_you_mean(key, others)}" if others else ""
        _log.warning("no process receives messages on `%s`%s", key, hint if "mean" in hint else "")

    def _declare(self, name: str, work: Callable[[AskedChannel], None]) -> None:
        """Declare something on the broker once.

        A refusal, as for a user with few permissions, is logged and not tried again on this connection.
        """
        if name in self._declared or name in self._refused:
            return
        try:
            with self.connection.asking() as channel:
                work(channel)
            self._declared.add(name)
        except ChannelClosedByBroker as error:
            self._refused.add(name)
            if error.reply_code == OTHERWISE:
                self._outage.warn_once(declared_otherwise(error.reply_text))
            else:
                why = error.reply_text
                _log.info("the broker at %s refused a declaration for `%s`: %s", self.address, name, why)
