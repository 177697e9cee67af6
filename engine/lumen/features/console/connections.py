"""The connections of the console's server, so that who never reads can be cut off."""

import asyncio
from typing import Any, cast

from uvicorn.protocols.http.h11_impl import H11Protocol

READ_TIMEOUT = 10.0
"""How long who is connected may read nothing of what waits for it [s]."""
HIGH_WATER = 262_144
"""How much may wait for one before its stream waits, too [bytes]; the system's own buffers come on top."""

_open: dict[tuple[str, int], asyncio.Transport] = {}


class KnownConnection(H11Protocol):
    """A connection that is known by the address of who made it."""

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        super().connection_made(transport)
        transport.set_write_buffer_limits(high=HIGH_WATER)
        self._peer: Any = transport.get_extra_info("peername")
        if self._peer:
            _open[cast("tuple[str, int]", tuple(self._peer[:2]))] = transport

    def connection_lost(self, exc: Exception | None) -> None:
        if self._peer:
            _open.pop(cast("tuple[str, int]", tuple(self._peer[:2])), None)
        super().connection_lost(exc)


def cut_off(client: tuple[str, int] | None) -> None:
    """End a connection at once, whatever waits for it."""
    if client and (transport := _open.get(client)):
        transport.abort()
