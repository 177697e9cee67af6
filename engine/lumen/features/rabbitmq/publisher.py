"""The sending connection, which tracks the broker's confirmations."""

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
"""The maximum number of sent, unconfirmed messages; further messages wait in the outbox."""
MAX_BY_GUEST = 8
"""The maximum number of waiting messages that a publishing thread sends, for example after an outage."""
MAX_UNCONFIRMED_BYTES = 4 * 1024 * 1024
"""The total body size of sent, unconfirmed messages above which no more are sent [bytes]."""
CONFIRM_TIME = 0.01
"""The time for which the broker's confirmations accumulate while more messages are sent [s]."""
IDLE_TIME = 0.5
"""The longest wait for events in one turn of the connection [s]."""
MAX_WARNED_KEYS = 1_000
"""The maximum number of keys without a receiver for which a warning is logged."""
PROBE_PERIOD = 1.0
"""The time for which a key counts as having no receiver, after a message found none [s]."""
PERSISTENT_DELIVERY = 2
"""AMQP's delivery mode for messages that a broker writes to disk."""

_log = logging.getLogger(__name__)


class _Sent(NamedTuple):
    """A sent message that the broker has not confirmed yet."""

    size: int
    """The size of its body [bytes]."""
    again: OutgoingMessage | None
    """The message to resend after a refusal or a lost connection; None if the message may be lost."""


class Publisher(BrokerConnection):
    """Sends the messages of the outbox; while the broker is away, messages wait there.

    The thread that publishes a message also sends it; the connection's own thread receives confirmations and sends
    messages that had to wait. At most `MAX_UNCONFIRMED_MESSAGES` are sent without confirmation. After a connection
    loss, unconfirmed messages that must arrive are resent first. Keys without a receiver are logged with the nearest
    of the `known` keys. `journals` are the queues that store outgoing messages until a module reads them. `returned` is
    called with the key of each message without a receiver. If it is None, the broker returns only messages that must
    arrive and messages under keys passed to `heard`.
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
        """Whether the side queues for unusable messages are declared on the broker."""
        return SIDE_QUEUES in self._declared

    def serve(self) -> bool:
        """Send waiting messages, unless the broker is blocked, and process the broker's answers.

        Return False if the end is requested and all messages are confirmed, or the broker is blocked.
        """
        if self.connection.blocked:  # time to live counts in the outbox; messages sent now would arrive too late
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
        """Return unconfirmed messages that must arrive to the outbox, and close the connection."""
        self._prepared = None
        lost, self._window, self._bytes = self._window, {}, 0
        self.outbox.put_back([sent.again for sent in lost.values() if sent.again])
        connection.close()

    def end(self, timeout: float) -> bool:
        """Send the remaining messages and end; return whether the thread ended within `timeout` [s]."""
        self.ending.set()
        if connection := self.connection:
            connection.wake()
        return self.join(timeout)

    def _send_now(self) -> None:
        """Send waiting messages in the caller's thread if possible, else in the connection's own thread."""
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
        except Exception as error:  # AMQP can't carry it; a second attempt would fail again
            self.unsendable.add(message.key, f"AMQP cannot carry it: {error!r}")
            return
        self._number += 1
        self._window[self._number] = _Sent(len(message.body), message if message.must else None)
        self._bytes += len(message.body)

    def _confirmed(self, number: int, several: bool) -> None:
        """Record that the broker has this message, and if `several`, all earlier messages."""
        self._settled(number, several)

    def _nacked(self, number: int, several: bool) -> None:
        messages = self._settled(number, several)
        _log.warning("the broker at %s did not accept %s", self.address, counted(len(messages), "message"))
        self.outbox.put_back([sent.again for sent in messages if sent.again])

    def _settled(self, number: int, several: bool) -> list[_Sent]:
        """Remove from the window the messages that the broker has confirmed or rejected, and return them."""
        first = next(iter(self._window), 0) if several else number
        messages = [sent for n in range(first, number + 1) if (sent := self._window.pop(n, None))]
        self._bytes -= sum(sent.size for sent in messages)
        return messages

    def _returned(self, _: Any, method: Any, properties: Any, body: bytes) -> None:
        """Handle a message without a receiver.

        A message that must arrive is sent to the side queue, where operators can find it.
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
        """Return False if a message under this key found no receiver within the last PROBE_PERIOD, else True.

        After the first call, the broker reports each message under this key that has no receiver.
        """
        self._probed.add(key)
        return time.monotonic() - self._missed.get(key, -PROBE_PERIOD) >= PROBE_PERIOD

    def _miss(self, key: str) -> None:
        if key in self._probed:
            self._missed[key] = time.monotonic()

    def unrouted(self, key: str) -> None:
        """Record that a message under this key had no receiver; log a warning if no route has the key."""
        self._miss(key)
        if key not in self.known:
            self.warn_once(key)

    def warn_once(self, key: str) -> None:
        """Log once per key, for at most MAX_WARNED_KEYS keys, that no process receives its messages."""
        if key in self._warned or len(self._warned) >= MAX_WARNED_KEYS:
            return
        self._warned.add(key)
        others = [other for other in self.known if other != key]
        hint = f": {did_you_mean(key, others)}" if others else ""
        _log.warning("no process receives messages on `%s`%s", key, hint if "mean" in hint else "")

    def _declare(self, name: str, work: Callable[[AskedChannel], None]) -> None:
        """Run the declaration `work`, called `name` in logs, once per connection.

        A refusal, for example because of a missing permission, is logged and not retried on this connection.
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
