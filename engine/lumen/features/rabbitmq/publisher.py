"""A connection that sends, and knows of every message whether the broker has it."""

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
"""Messages that are sent and not confirmed yet; more wait in the outbox."""
MAX_BY_GUEST = 8
"""How many messages that wait, after an outage perhaps, somebody who publishes another one sends with it."""
MAX_UNCONFIRMED_BYTES = 4 * 1024 * 1024
"""Their bodies [bytes]."""
CONFIRM_TIME = 0.01
"""For how long what the broker says of messages is left to gather while more are sent [s]."""
IDLE_TIME = 0.5
"""How long the connection is left to itself while there is nothing to send [s]."""
MAX_WARNED_KEYS = 1_000
"""Keys that nobody takes and that were warned of; more are not."""
PROBE_PERIOD = 1.0
"""How often it is tried whether somebody takes by now what nobody took before [s]."""
PERSISTENT_DELIVERY = 2
"""AMQP's delivery mode of a message that a broker writes to its disk."""

_log = logging.getLogger(__name__)


class _Sent(NamedTuple):
    """A message that was sent, of so many bytes, and what to send `again` where the connection is lost."""

    size: int
    again: OutgoingMessage | None


class Publisher(BrokerConnection):
    """Sends what is in the outbox; what is there when the broker is away waits for it to come back.

    Who publishes sends, on its own thread; the connection's hears what the broker says of it, and sends what waited.
    At most `MAX_UNCONFIRMED_MESSAGES` are sent without the broker's confirmation. When the connection is lost, those of
    them that must arrive are the next again. What nobody takes is logged with the nearest of the `known` keys.
    `journals` are the queues that keep what goes out until a module reads it. `returned` is called with each key whose
    message nobody takes; without it only those come back that must arrive.
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
        self.address.check_version(self.connection.server)
        self._number, self._declared, self._refused = 0, set(), set()
        self._declare(SIDE_QUEUES, declare_side_queues)
        self.channel.add_on_return_callback(self._returned)
        self.connection.confirm(self._confirmed, self._nacked)

    @property
    def blocked(self) -> bool:
        """Whether the broker accepts no messages from this connection now."""
        connection = self.connection
        return bool(connection and connection.blocked)

    @property
    def has_side_queues(self) -> bool:
        """Whether the broker let us declare the side queues for unusable messages."""
        return SIDE_QUEUES in self._declared

    def serve(self) -> bool:
        if self.connection.blocked:  # a message sent now would be used late: in the outbox its time to live counts
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
        self._prepared = None
        lost, self._window, self._bytes = self._window, {}, 0
        self.outbox.put_back([sent.again for sent in lost.values() if sent.again])
        connection.close()

    def end(self, timeout: float) -> bool:
        """Send the rest and end; whether that was done within `timeout` [s]."""
        self.ending.set()
        if connection := self.connection:
            connection.wake()
        return self.join(timeout)

    def _send_now(self) -> None:
        """Whoever has put something sends it; unless the connection is in use, then its thread does."""
        connection = self.connection
        if connection and not connection.lend(self._send_as_guest):
            connection.wake()

    def _send_as_guest(self) -> bool:
        """Send what waits, if it is not much; false where the connection's thread has something to do."""
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
        except Exception as error:  # it can't be written down: sent again, it would end the connection again
            self.unsendable.add(message.key, f"AMQP cannot carry it: {error!r}")
            return
        self._number += 1
        self._window[self._number] = _Sent(len(message.body), message if message.must else None)
        self._bytes += len(message.body)

    def _confirmed(self, number: int, several: bool) -> None:
        """The broker has this message, and with `several` all before it."""
        self._settled(number, several)

    def _nacked(self, number: int, several: bool) -> None:
        messages = self._settled(number, several)
        _log.warning("the broker at %s did not accept %s", self.address, counted(len(messages), "message"))
        self.outbox.put_back([sent.again for sent in messages if sent.again])

    def _settled(self, number: int, several: bool) -> list[_Sent]:
        """Messages of which the broker has said something."""
        first = next(iter(self._window), 0) if several else number
        messages = [sent for n in range(first, number + 1) if (sent := self._window.pop(n, None))]
        self._bytes -= sum(sent.size for sent in messages)
        return messages

    def _returned(self, _: Any, method: Any, properties: Any, body: bytes) -> None:
        """Nobody is there for a message; one that must arrive is put where somebody can find it."""
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
        """Whether anybody takes what is sent under this key, as far as was seen in the last PROBE_PERIOD.

        Where that is not known it is true: what is sent then finds out.
        """
        self._probed.add(key)
        return time.monotonic() - self._missed.get(key, -PROBE_PERIOD) >= PROBE_PERIOD

    def _miss(self, key: str) -> None:
        if key in self._probed:
            self._missed[key] = time.monotonic()

    def unrouted(self, key: str) -> None:
        """Somebody sent a message under this key, and nobody took it: log it where no route has the key."""
        self._miss(key)
        if key not in self.known:
            self.warn_once(key)

    def warn_once(self, key: str) -> None:
        """Log once that nobody takes what is sent under this key."""
        if key in self._warned or len(self._warned) >= MAX_WARNED_KEYS:
            return
        self._warned.add(key)
        others = [other for other in self.known if other != key]
        hint = f": {did_you_mean(key, others)}" if others else ""
        _log.warning("no process receives messages on `%s`%s", key, hint if "mean" in hint else "")

    def _declare(self, name: str, work: Callable[[AskedChannel], None]) -> None:
        """Declare something on the broker once; where it refuses, as it does to a user of few rights, all goes on."""
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
