"""A connection that sends, and knows of every message whether the broker has it."""

import logging
import time
from collections.abc import Callable, Mapping
from typing import Any

import pika
from pika.exceptions import AMQPChannelError, AMQPConnectionError

from lumen.buses.broker import BrokerAddress
from lumen.buses.connection import BrokerConnection, OutageLog
from lumen.buses.outbox import Outbox, OutgoingMessage
from lumen.buses.polled import PolledConnection
from lumen.buses.properties import CAUSE_HEADER
from lumen.buses.queues import SIDE_QUEUES, UNROUTED, ChannelCall, Queue, declare_side_queues
from lumen.language.diagnostics import did_you_mean
from lumen.language.routes import FLOATS_TYPE, JPEG_TYPE
from lumen.upkeep.drops import DropLog

MAX_UNCONFIRMED_MESSAGES = 1_000
"""Messages that are sent and not confirmed yet; more wait in the outbox."""
MAX_UNCONFIRMED_BYTES = 4 * 1024 * 1024
"""Their bodies [bytes]."""
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
        self._warned: set[str] = set()
        self._probed: set[str] = set()
        self._missed: dict[str, float] = {}
        self.unsendable = DropLog(_log)

    def connect(self) -> PolledConnection:
        return PolledConnection(self.address.parameters)

    def open_channel(self) -> Any:
        return self.connection.open_channel()

    def begin(self) -> None:
        self.address.check_version(self.connection.server)
        self._number, self._declared, self._refused = 0, set(), set()
        self._declare(SIDE_QUEUES, declare_side_queues)
        self.channel.add_on_return_callback(self._returned)
        self.connection.ask(self.channel.confirm_delivery, self._confirmed)

    @property
    def has_side_queues(self) -> bool:
        """Whether the broker let us declare the places for what nobody could use."""
        return SIDE_QUEUES in self._declared

    def serve(self) -> bool:
        for key, queue in self.journals.items():
            self._declare(key, queue.declare)
        room = self._room()
        messages = self.outbox.take(room, 0.0) if room > 0 else []
        for sent, message in enumerate(messages):
            try:
                self._send(message)
            except BaseException:
                self.outbox.put_back(messages[sent:])
                raise
        self.connection.turn(IDLE_TIME if self._idle(bool(messages)) else 0.0)
        self.outbox.drops.tell()
        self.unsendable.tell()
        return bool(self.outbox or self._window) or not self.ending.is_set()

    def finish(self) -> None:
        """There is nothing left to wait for."""

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

    def _idle(self, busy: bool) -> bool:
        """Whether there is nothing to do until the broker says something, or there is something to send."""
        if self._room() <= 0:
            return True
        return not busy and self.outbox.sleep() and not (self.ending.is_set() and not self._window)

    def _send(self, message: OutgoingMessage) -> None:
        id, sender, sent, cause = message.origin
        properties = pika.BasicProperties(
            content_type=message.content_type,
            content_encoding="utf-8" if message.content_type not in (JPEG_TYPE, FLOATS_TYPE) else None,
            reply_to=message.reply_to or None,
            correlation_id=message.correlation_id or None,
            expiration=message.expiration,
            type=message.type or None,
            message_id=id or None,
            app_id=sender or None,
            timestamp=int(sent) or None,
            delivery_mode=PERSISTENT_DELIVERY if message.must else None,
            headers={**({CAUSE_HEADER: cause} if cause else {}), **(message.headers or {})} or None,
        )
        try:
            wanted = bool(message.must or (self.returned and message.exchange) or message.key in self._probed)
            self.channel.basic_publish(message.exchange, message.key, message.body, properties, mandatory=wanted)
        except (AMQPChannelError, AMQPConnectionError, OSError):
            raise
        except Exception as error:  # it can't be written down: sent again, it would end the connection again
            self.unsendable.add(message.key, f"AMQP can't carry it: {error!r}")
            return
        self._number += 1
        self._window[self._number] = message
        self._bytes += len(message.body)

    def _confirmed(self, frame: Any) -> None:
        """The broker has this message, and with `multiple` all before it; or (a nack) could not take it."""
        method = frame.method
        first = next(iter(self._window), 0) if method.multiple else method.delivery_tag
        numbers = range(first, method.delivery_tag + 1)
        messages = [message for n in numbers if (message := self._window.pop(n, None))]
        self._bytes -= sum(len(message.body) for message in messages)
        if isinstance(method, pika.spec.Basic.Nack):
            _log.warning("the broker at %s could not take %d messages", self.address, len(messages))
            self.outbox.put_back([message for message in messages if message.must])

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

    def _declare(self, name: str, work: Callable[[ChannelCall, Any], None]) -> None:
        """Declare something on the broker once; where it refuses, as it does to a user of few rights, all goes on."""
        if name in self._declared or name in self._refused:
            return
        if refusal := self.connection.attempt(work):
            self._refused.add(name)
            _log.info("the broker at %s does not let us make what keeps `%s`: %s", self.address, name, refusal)
        else:
            self._declared.add(name)
