"""A device that takes Open Sound Control over UDP, and is heard on a port of ours where that is wanted."""

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
"""How soon a listener notices that it is to end [s]."""
RETRY = 5.0
"""How often a port of ours that was taken, or an unknown name, is tried again [s]."""
MAX_DATAGRAM = 65_535
"""Of UDP [bytes]."""


class OscDevice:
    """Sends routes of `link` to the device, and hands what it sends to `deliver`; `incoming` names those routes.

    What others than the device send is dropped and counted. Where its name is unknown, or the port is taken, that is
    said, and tried again.
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
        return self._link.routes

    def begin(self) -> None:
        with suppress(OSError):
            self._opened()

    def send(self, route: str, body: Any) -> None:
        message = message_of(self._link.routes[route].address, body, self._fields[route])
        try:
            self._opened().sendto(message, self._device)
        except OSError as error:
            self._health.down(f"cannot be sent to ({error.strerror or error}): Lumen tries again with the next message")
            raise ModuleError("the device cannot be reached") from None

    def tick(self) -> None:
        if self._socket is None and self._link.listen and self._clock() >= self._again:
            self.begin()
            self._again = self._clock() + RETRY
        self._health.tick()

    def close(self) -> None:
        self._closing = True
        if self._socket:
            with suppress(OSError):  # a socket of UDP is woken by its end only where it is shut down first
                self._socket.shutdown(socket.SHUT_RDWR)
            self._socket.close()
        if self._thread:
            self._thread.join(5.0)

    def _opened(self) -> socket.socket:
        """The socket, made where there is none; raises OSError, and says why."""
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
                continue  # what was sent before met nobody
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
    """The address of ours that leads to the device: nobody is listened to on another network."""
    with socket.socket(family, socket.SOCK_DGRAM) as probe:
        probe.connect(device)
        return str(probe.getsockname()[0])
