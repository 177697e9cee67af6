"""A device that receives Open Sound Control (OSC) over UDP, and can send it to a port of this computer."""

import socket
import time
from collections.abc import Callable, Collection, Mapping, Sequence
from contextlib import suppress
from typing import Any

from lumen.errors import ModuleError
from lumen.features.show.arguments import body_of_arguments, message_of, messages_of
from lumen.features.show.device_link import TakeFromDevice
from lumen.features.show.health import LinkHealth
from lumen.features.show.settings import OscLink
from lumen.project.message_fields import SchemaField
from lumen.upkeep.drops import Drops
from lumen.upkeep.threads import WatchedThread

POLL = 0.5
"""The time between two checks whether a listener should end [s]."""
RETRY = 5.0
"""The time between two attempts to listen, for example while the port is in use [s]."""
MAX_DATAGRAM = 65_535
"""The largest UDP datagram [bytes]."""


class OscDevice:
    """Sends routes of `link` to the device, and passes its messages on the routes `incoming` to `deliver`.

    Messages from other senders are dropped and counted. If the device's name is unknown or the port is in use, that is
    reported, and opening the socket is retried.
    """

    def __init__(
        self,
        link: OscLink,
        fields: Mapping[str, Sequence[SchemaField]],
        incoming: Sequence[str],
        deliver: TakeFromDevice,
        drops: Drops,
        health: LinkHealth,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._link, self._fields, self._deliver, self._clock = link, fields, deliver, clock
        self._drops, self._health = drops, health
        self._routes = {link.routes[route].address: route for route in incoming}
        self._socket: socket.socket | None = None
        self._device: Any = None
        self._closing, self._again = False, 0.0
        self._thread: WatchedThread | None = None

    @property
    def routes(self) -> Collection[str]:
        """The routes that the device carries."""
        return self._link.routes

    def begin(self) -> None:
        """Open the socket if possible; a failure is only reported."""
        with suppress(OSError):
            self._opened()

    def send(self, route: str, body: Any) -> None:
        """Send a body on a route. Raises ModuleError if the body is invalid or the device can't be reached."""
        message = message_of(self._link.routes[route].address, body, self._fields[route])
        try:
            self._opened().sendto(message, self._device)
        except OSError as error:
            self._health.down(f"cannot be sent to ({error.strerror or error}): Lumen tries again with the next message")
            raise ModuleError("the device cannot be reached") from None

    def tick(self) -> None:
        """Open a listening socket again if necessary, and update the device's health."""
        if self._socket is None and self._link.listen and self._clock() >= self._again:
            self.begin()
            self._again = self._clock() + RETRY
        self._health.tick()

    def close(self) -> None:
        """Close the socket and end the thread."""
        self._closing = True
        if self._socket:
            with suppress(OSError):  # only a shutdown wakes a thread that waits on a UDP socket
                self._socket.shutdown(socket.SHUT_RDWR)
            self._socket.close()
        if self._thread:
            self._thread.join(5.0)

    def _opened(self) -> socket.socket:
        """Return the socket, and open it if necessary. Raises OSError after reporting the reason."""
        if self._socket:
            return self._socket
        try:
            found = socket.getaddrinfo(self._link.host, self._link.port, type=socket.SOCK_DGRAM)[0]
            opened = socket.socket(found[0], socket.SOCK_DGRAM)
            try:
                if self._link.listen:
                    opened.bind((_own_address(found[0], found[4]), self._link.listen))
                    opened.settimeout(POLL)
            except OSError:
                opened.close()
                raise
        except (OSError, UnicodeError) as error:
            why = getattr(error, "strerror", None) or error
            self._health.down(f"cannot be reached ({why}): Lumen tries again")
            raise OSError(str(why)) from None
        self._socket, self._device = opened, found[4]
        self._health.up()
        if self._link.listen:
            self._thread = WatchedThread("lumen-show-osc", self._listen)
            self._thread.start()
        return opened

    def _listen(self) -> None:
        assert self._socket
        while not self._closing:
            try:
                data, sender = self._socket.recvfrom(MAX_DATAGRAM)
            except TimeoutError:
                continue
            except OSError:
                if self._closing:
                    return
                continue  # an earlier message reached no receiver
            if sender[0] != self._device[0]:
                self._drops.add(f"the port {self._link.listen} (OSC)", f"{sender[0]} is not {self._link.host}")
                continue
            self._take(data)

    def _take(self, data: bytes) -> None:
        try:
            messages = messages_of(data)
        except ModuleError as error:
            self._drops.add(f"the port {self._link.listen} (OSC)", str(error))
            return
        for address, arguments in messages:
            route = self._routes.get(address)
            if route is None:
                self._drops.add(f"the port {self._link.listen} (OSC)", f"no route has the address {address[:80]}")
                continue
            fields = self._fields[route]
            self._deliver(route, f"{address} (OSC)", lambda a=arguments, f=fields: body_of_arguments(a, f))  # type: ignore[misc]


def _own_address(family: int, device: Any) -> str:
    """Return the local address on the device's network; listening on that address excludes other networks."""
    with socket.socket(family, socket.SOCK_DGRAM) as probe:
        probe.connect(device)
        return str(probe.getsockname()[0])
