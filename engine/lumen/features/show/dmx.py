"""A DMX universe over sACN: the newest level of each channel, sent after each message and repeated."""

import ipaddress
import socket
import time
import uuid
from collections.abc import Callable, Collection, Mapping
from contextlib import suppress
from typing import Any

from lumen.errors import ModuleError
from lumen.features.show.channels import CHANNELS, PORT, channel_level, data_packet, multicast_group
from lumen.features.show.health import LinkHealth
from lumen.features.show.settings import DmxLink
from lumen.project.message_fields import SchemaField

KEEP_ALIVE = 0.8
"""The time between two packets with unchanged levels [s]; E1.31 (6.6.2) requires 0.8 to 1.0."""
GOODBYES = 3
"""The number of packets that announce the end of the stream (E1.31, 6.2.6)."""
MULTICAST_REACH = 8
"""The time to live of multicast packets [hops]."""


class DmxUniverse:
    """Sends one universe, but nothing before the first message, because a start must not darken the hall.

    A channel is 0 if it has no field, or its field has no value yet. A field missing from a body keeps its level.
    """

    def __init__(
        self,
        link: DmxLink,
        fields: Mapping[str, Mapping[str, SchemaField]],
        source: str,
        health: LinkHealth,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._link, self._fields, self._source = link, fields, source
        self._health, self._clock = health, clock
        self._component = uuid.uuid4().bytes
        self._levels = bytearray(CHANNELS)
        self._sequence = 0
        self._sent: float | None = None
        self._socket: socket.socket | None = None

    @property
    def routes(self) -> Collection[str]:
        """The routes that the universe carries."""
        return self._link.routes

    def begin(self) -> None:
        """Do nothing, because sACN needs no connection."""

    def send(self, route: str, body: Any) -> None:
        """Send the levels of a body's fields. Raises ModuleError if the body has no fields or a value is invalid."""
        if not isinstance(body, Mapping):
            raise ModuleError("the body has no fields")
        wanted = {
            channel: channel_level(body[name], self._fields[route][name])
            for name, channel in self._link.routes[route].items()
            if name in body
        }
        for channel, level in wanted.items():
            self._levels[channel - 1] = level
        self._transmit()

    def tick(self) -> None:
        """Repeat the levels after KEEP_ALIVE, and update the link's health."""
        if self._sent is not None and self._clock() - self._sent >= KEEP_ALIVE:
            self._transmit()
        self._health.tick()

    def close(self) -> None:
        """Announce the end of a stream that has begun, and close the socket."""
        if self._sent is not None:
            for _ in range(GOODBYES):
                self._transmit(terminated=True)
        if self._socket:
            self._socket.close()

    def _transmit(self, *, terminated: bool = False) -> None:
        packet = data_packet(
            bytes(self._levels), self._link.universe, self._sequence,
            source=self._source, component=self._component, terminated=terminated,
        )  # fmt: skip
        self._sequence, self._sent = (self._sequence + 1) % 256, self._clock()
        try:
            self._opened().sendto(packet, (self._link.host or multicast_group(self._link.universe), PORT))
        except (OSError, UnicodeError) as error:
            why = getattr(error, "strerror", None) or error
            self._health.down(f"cannot be sent to ({why}): Lumen tries again")
        else:
            self._health.up()

    def _opened(self) -> socket.socket:
        if self._socket is None:
            family = socket.AF_INET
            with suppress(ValueError):
                family = socket.AF_INET6 if ipaddress.ip_address(self._link.host).version == 6 else family
            self._socket = socket.socket(family, socket.SOCK_DGRAM)
            if not self._link.host:
                self._socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, MULTICAST_REACH)
        return self._socket
