"""The connection that sends."""

import logging

import pika

from lumen.buses.addresses import Address
from lumen.buses.links import Link
from lumen.buses.outbox import Outbox, Parcel

BATCH = 100
IDLE = 0.5

_log = logging.getLogger(__name__)


class Publishing(Link):
    """Sends what is in the outbox; what is there when the broker is away waits for it to come back.

    Between batches, and twice a second while idle, the connection lives: heartbeats, and the news that it is lost.
    """

    def __init__(self, address: Address) -> None:
        super().__init__(address, "out")
        self.outbox = Outbox()
        self._reported = 0

    def serve(self) -> bool:
        parcels = self.outbox.take(BATCH, IDLE)
        for sent, parcel in enumerate(parcels):
            try:
                self._send(parcel)
            except BaseException:
                self.outbox.put_back(parcels[sent:])
                raise
        self.process(0)
        self._report_dropped()
        return bool(self.outbox) or not self.ending.is_set()

    def end(self, timeout: float) -> bool:
        """Send the rest and end; whether that was done within `timeout` [s]."""
        self.ending.set()
        self.outbox.wake()
        return self.join(timeout)

    def _send(self, parcel: Parcel) -> None:
        properties = pika.BasicProperties(
            content_type=parcel.content_type,
            content_encoding="utf-8",
            reply_to=parcel.reply_to or None,
            correlation_id=parcel.correlation_id or None,
            expiration=parcel.expiration,
            type=parcel.type or None,
        )
        self.channel.basic_publish(parcel.exchange, parcel.key, parcel.body, properties)

    def _report_dropped(self) -> None:
        if self.outbox.dropped > self._reported:
            _log.warning("%d messages were dropped: the outbox was full", self.outbox.dropped - self._reported)
            self._reported = self.outbox.dropped
