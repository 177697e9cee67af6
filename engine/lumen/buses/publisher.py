"""A connection that sends, and knows of every message whether the broker has it."""

import logging
import time
from collections.abc import Callable, Mapping
from typing import Any

from pika.exceptions import AMQPChannelError, AMQPConnectionError, ChannelClosedByBroker

from lumen.buses.asked_channel import AskedChannel
from lumen.buses.broker import BrokerAddress
from lumen.buses.connection import BrokerConnection, OutageLog
from lumen.buses.outbox import Outbox, OutgoingMessage
from lumen.buses.polled import PolledConnection
from lumen.buses.properties import CAUSE_HEADER, write_properties
from lumen.buses.queues import SIDE_QUEUES, UNROUTED, Queue, declare_side_queues
from lumen.language.diagnostics import did_you_mean
from lumen.language.routes import FLOATS_TYPE, JPEG_TYPE
from lumen.upkeep.drops import DropLog

MAX_UNCONFIRMED_MESSAGES = 1_000
"""Messages that are sent and not confirmed yet; more wait in the outbox."""
MAX_UNCONFIRMED_BYTES = 4 * 1024 * 1024
"""Their bodies [bytes]."""
GATHER_TIME = 0.01
"""How long the next message is waited for before what the broker says of the last one is waited for [s]."""
IDLE_TIME = 0.5
"""How long the connection is left to itself while there is nothing to send [s]."""
MAX_WARNED_KEYS = 1_000
"""Keys that nobody takes and that were warned of; more are not."""
PROBE_PERIOD = 1.0
"""How often it is tried whether somebody takes by now what nobody took before [s]."""
PERSISTENT_DELIVERY = 2
"""AMQP's delivery mode of a message that a broker writes to its disk."""

_log = logging.getLogger(__name__)


class Publisher(BrokerConnection):
    """Sends what is in the outbox; what is there when the broker is away waits for it to come back.

    At most `MAX_UNCONFIRMED_MESSAGES` are sent without the broker's confirmation. When the connection is lost, those of
    them that must arrive are the next again. What nobody takes is logged with the nearest of the `known` keys.
    `journals` are the queues that keep what goes out until a module reads it. `returned` is called with each key whose
    message nobody takes; without it only those come back that must arrive.
    """

    def __init__(self, address: BrokerAddress, name: str, outage: OutageLog) -> None:
        super().__init__(address, name, outage)
        self.outbox = Outbox(self._awaken)
        self.known: tuple[str, ...] = ()
        self.journals: Mapping[str, Queue] = {}
        self.returned: Callable[[str], None] | None = None
        self._declared: set[str] = set()
        self._refused: set[str] = set()
        self._window: dict[int, OutgoingMessage] = {}
        self._bytes = self._number = 0
        self._busy = False
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
    def has_side_queues(self) -> bool:
        """Whether the broker let us declare the places for what nobody could use."""
        return SIDE_QUEUES in self._declared

    def serve(self) -> bool:
        for key, queue in self.journals.items():
            self._declare(key, queue.declare)
        room = self._room()
        messages = self.outbox.take(room, GATHER_TIME if self._busy else 0.0) if room > 0 else []
        for sent, message in enumerate(messages):
            try:
                self._send(message)
            except BaseException:
                self.outbox.put_back(messages[sent:])
                raise
        self._busy = bool(messages)
        self.connection.turn(0.0 if self._busy or not self._idle() else IDLE_TIME)
        self.outbox.drops.tell()
        self.unsendable.tell()
        return bool(self.outbox or self._window) or not self.ending.is_set()

    def disconnect(self, connection: PolledConnection) -> None:
        lost, self._window, self._bytes = self._window, {}, 0
        self.outbox.put_back([message for message in lost.values() if message.must])
        connection.close()

    def end(self, timeout: float) -> bool:
        """Send the rest and end; whether that was done within `timeout` [s]."""
        self.ending.set()
        self.outbox.wake()
        return self.join(timeout)

    def _awaken(self) -> None:
        if connection := self.connection:
            connection.wake()

    def _room(self) -> int:
        return 0 if self._bytes > MAX_UNCONFIRMED_BYTES else MAX_UNCONFIRMED_MESSAGES - len(self._window)

    def _idle(self) -> bool:
        """Whether there is nothing to do until the broker says something, or there is something to send."""
        if self._room() <= 0:
            return True
        return self.outbox.sleep() and not (self.ending.is_set() and not self._window)

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
            self.unsendable.add(message.key, f"AMQP can't carry it: {error!r}")
            return
        self._number += 1
        self._window[self._number] = message
        self._bytes += len(message.body)

    def _confirmed(self, number: int, several: bool) -> None:
        """The broker has this message, and with `several` all before it."""
        self._settled(number, several)

    def _nacked(self, number: int, several: bool) -> None:
        messages = self._settled(number, several)
        _log.warning("the broker at %s could not take %d messages", self.address, len(messages))
        self.outbox.put_back([message for message in messages if message.must])

    def _settled(self, number: int, several: bool) -> list[OutgoingMessage]:
        """Messages that are in the broker's hands no more, or for good."""
        first = next(iter(self._window), 0) if several else number
        messages = [message for n in range(first, number + 1) if (message := self._window.pop(n, None))]
        self._bytes -= sum(len(message.body) for message in messages)
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
            headers = {"reason": f"nobody takes `{key}`"}
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
        _log.warning("nobody takes what is sent on `%s`%s", key, hint if "mean" in hint else "")

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
            why = error.reply_text
            _log.info("the broker at %s does not let us make what keeps `%s`: %s", self.address, name, why)
