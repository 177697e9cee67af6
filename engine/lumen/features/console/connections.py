"""The open connections of the console's server, kept to cut off clients that stop reading."""

import asyncio
from typing import Any, cast

from uvicorn.protocols.http.h11_impl import H11Protocol

READ_TIMEOUT = 10.0
"""The maximum time for which a client can leave data unread [s]."""
HIGH_WATER = 262_144
"""The amount of a client's unread data at which its stream waits [bytes], besides the system's buffers."""

_open: dict[tuple[str, int], asyncio.Transport] = {}


class KnownConnection(H11Protocol):
    """A connection that `cut_off` can find by its client's address."""

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
    """Abort a client's connection, if it is open; unsent data is lost."""
    if client and (transport := _open.get(client)):
        transport.abort()
