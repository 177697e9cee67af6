"""A connection that sends, and knows of every message whether the broker has it."""

import logging
from collections.abc import Callable, Mapping
from typing import Any

import pika

from lumen.buses.broker import BrokerAddress
from lumen.buses.connection import BrokerConnection, OutageLog
from lumen.buses.outbox import Outbox, OutgoingMessage
from lumen.buses.polled import PolledConnection
from lumen.buses.queues import ASIDE, NOWHERE, ChannelCall, Queue, declare_aside
from lumen.language.diagnostics import did_you_mean

WINDOW = 1_000
WINDOW_BYTES = 4 * 1024 * 1024
IDLE = 0.5
TOLD = 1_000
PERSISTENT = 2

_log = logging.getLogger(__name__)


class Publisher(BrokerConnection):
    """Sends what is in the outbox; what is there when the broker is away waits for it to come back.

    At most `WINDOW` messages are under way without the broker's word that it has them. When the connection is lost,
    those of them that must arrive are the next again; what nobody waits for is told with the nearest of the `known`
    keys. `journals` are the queues that keep what goes out until a module comes for it.
    """

    def __init__(self, address: BrokerAddress, name: str, outage: OutageLog) -> None:
        super().__init__(address, name, outage)
        self.outbox = Outbox(self._awaken)
        self.known: tuple[str, ...] = ()
        self.journals: Mapping[str, Queue] = {}
        self._declared: set[str] = set()
        self._refused: set[str] = set()
        self._window: dict[int, OutgoingMessage] = {}
        self._bytes = self._number = self._dropped = self._late = 0
        self._told: set[str] = set()

    def connect(self) -> PolledConnection:
        return PolledConnection(self.address.parameters)

    def open_channel(self) -> Any:
        return self.connection.open_channel()

    def begin(self) -> None:
        self.address.check_version(self.connection.server)
        self._number, self._declared, self._refused = 0, set(), set()
        self._make(ASIDE, declare_aside)
        self.channel.add_on_return_callback(self._returned)
        self.connection.ask(self.channel.confirm_delivery, self._confirmed)

    @property
    def aside(self) -> bool:
        """Whether the broker let us make the places for what nobody could use."""
        return ASIDE in self._declared

    def serve(self) -> bool:
        for key, queue in self.journals.items():
            self._make(key, queue.declare)
        room = self._room()
        parcels = self.outbox.take(room, 0.0) if room > 0 else []
        for sent, parcel in enumerate(parcels):
            try:
                self._send(parcel)
            except BaseException:
                self.outbox.put_back(parcels[sent:])
                raise
        self.connection.turn(IDLE if self._idle(bool(parcels)) else 0.0)
        self._report()
        return bool(self.outbox or self._window) or not self.ending.is_set()

    def finish(self) -> None:
        """There is nothing left to wait for."""

    def disconnect(self, connection: PolledConnection) -> None:
        lost, self._window, self._bytes = self._window, {}, 0
        self.outbox.put_back([parcel for parcel in lost.values() if parcel.id])
        connection.close()

    def end(self, timeout: float) -> bool:
        """Send the rest and end; whether that was done within `timeout` [s]."""
        self.ending.set()
        self.outbox.wake()
        return self.join(timeout)

    def _awaken(self) -> None:
        if flow := self.connection:
            flow.wake()

    def _room(self) -> int:
        return 0 if self._bytes > WINDOW_BYTES else WINDOW - len(self._window)

    def _idle(self, busy: bool) -> bool:
        """Whether there is nothing to do until the broker says something, or there is something to send."""
        if self._room() <= 0:
            return True
        return not busy and self.outbox.sleep() and not (self.ending.is_set() and not self._window)

    def _send(self, parcel: OutgoingMessage) -> None:
        properties = pika.BasicProperties(
            content_type=parcel.content_type,
            content_encoding="utf-8",
            reply_to=parcel.reply_to or None,
            correlation_id=parcel.correlation_id or None,
            expiration=parcel.expiration,
            type=parcel.type or None,
            message_id=parcel.id or None,
            delivery_mode=PERSISTENT if parcel.id else None,
            headers=parcel.headers,
        )
        self._number += 1
        self._window[self._number] = parcel
        self._bytes += len(parcel.body)
        self.channel.basic_publish(parcel.exchange, parcel.key, parcel.body, properties, mandatory=bool(parcel.id))

    def _confirmed(self, frame: Any) -> None:
        """The broker has this message, and with `multiple` all before it; or (a nack) could not take it."""
        method = frame.method
        first = next(iter(self._window), 0) if method.multiple else method.delivery_tag
        numbers = range(first, method.delivery_tag + 1)
        parcels = [parcel for n in numbers if (parcel := self._window.pop(n, None))]
        self._bytes -= sum(len(parcel.body) for parcel in parcels)
        if isinstance(method, pika.spec.Basic.Nack):
            _log.warning("the broker at %s could not take %d messages", self.address, len(parcels))
            self.outbox.put_back([parcel for parcel in parcels if parcel.id])

    def _returned(self, _: Any, method: Any, properties: Any, body: bytes) -> None:
        """Nobody is there for a message that must arrive: it is put where somebody can find it."""
        key = method.routing_key
        if method.exchange == NOWHERE:
            return
        self.lament(key)
        if self.aside:
            headers = {"reason": f"nobody takes `{key}`"}
            self.outbox.put(OutgoingMessage(NOWHERE, key, body, properties.content_type or "", headers=headers))

    def stray(self, key: str) -> None:
        """Somebody sent a message under this key, and nobody took it: that is worth a word where no route has it."""
        if key not in self.known:
            self.lament(key)

    def lament(self, key: str) -> None:
        """Say once that nobody takes what is sent under this key."""
        if key in self._told or len(self._told) >= TOLD:
            return
        self._told.add(key)
        others = [other for other in self.known if other != key]
        hint = f": {did_you_mean(key, others)}" if others else ""
        _log.warning("nobody takes what is sent on `%s`%s", key, hint if "mean" in hint else "")

    def _make(self, name: str, work: Callable[[ChannelCall, Any], None]) -> None:
        """Make something on the broker once; where it refuses, as it does to a module with few rights, all goes on."""
        if name in self._declared or name in self._refused:
            return
        if refusal := self.connection.attempt(work):
            self._refused.add(name)
            _log.info("the broker at %s does not let us make what keeps `%s`: %s", self.address, name, refusal)
        else:
            self._declared.add(name)

    def _report(self) -> None:
        outbox = self.outbox
        if outbox.dropped > self._dropped:
            _log.warning("%d messages were dropped: the outbox was full", outbox.dropped - self._dropped)
            self._dropped = outbox.dropped
        if outbox.late > self._late:
            _log.warning("%d messages were dropped: they were too old to be sent", outbox.late - self._late)
            self._late = outbox.late
