"""The address of a local bus server, with the key that its clients need."""

import os
import secrets
import socket
import tempfile
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from lumen.errors import BusAddressError

MAX_SOCKET_PATH_BYTES = 100
"""Longest path of a socket [bytes]: systems allow 104 to 108."""
SOCKET_NAME = "door.sock"
TEMPORARY_PREFIX = "lumen-door-"
"""Beginning of the name of a folder that is made for a socket whose path would be too long."""
ANSWER_TIMEOUT = 30.0
"""Longest wait for the server's answer [s]: the exhibition may load files meanwhile, on a small, busy machine."""


@dataclass(frozen=True)
class LocalAddress:
    """The address of a server on this machine."""

    path: str = ""
    """The path of the server's socket; empty if the server uses a port."""
    port: int = 0
    """Port on loopback, on systems without such sockets."""
    key: str = ""
    """The secret that both sides must have."""

    @staticmethod
    def of(data: Mapping[str, Any]) -> "LocalAddress":
        """Return the address in the data of a file. Raises BusAddressError if the data has no address."""
        try:
            return LocalAddress(str(data["path"]), int(data["port"]), str(data["key"]))
        except (KeyError, TypeError, ValueError, OverflowError) as error:
            raise BusAddressError(f"this is not an address: {error!r}") from None

    def connect(self) -> socket.socket:
        """Return a connection to the server. Raises OSError if none listens."""
        wire = socket.socket(socket.AF_UNIX if self.path else socket.AF_INET)
        wire.settimeout(ANSWER_TIMEOUT)
        try:
            wire.connect(self.path or ("127.0.0.1", self.port))
        except OSError:
            wire.close()
            raise
        except (TypeError, ValueError, OverflowError) as error:
            wire.close()
            raise OSError(str(error)) from None
        return wire

    def remove(self) -> None:
        """Delete the socket's file, and a folder that was made for it."""
        if self.path:
            with suppress(OSError):
                os.unlink(self.path)
            if Path(self.path).parent.name.startswith(TEMPORARY_PREFIX):
                with suppress(OSError):
                    os.rmdir(Path(self.path).parent)


def listen(folder: Path) -> tuple[socket.socket, LocalAddress]:
    """Return a socket that listens in a folder, and its address. Raises OSError on failure.

    If the folder's path is too long, the socket is in a temporary folder. Without Unix sockets, it is a port on
    loopback.
    """
    key = secrets.token_hex(32)
    if not hasattr(socket, "AF_UNIX"):
        listener = socket.create_server(("127.0.0.1", 0))
        return listener, LocalAddress(port=listener.getsockname()[1], key=key)
    folder = folder.absolute()  # processes in other folders read the address
    if len(os.fsencode(folder / SOCKET_NAME)) > MAX_SOCKET_PATH_BYTES:
        folder = Path(tempfile.mkdtemp(prefix=TEMPORARY_PREFIX))
    path = folder / SOCKET_NAME
    with suppress(FileNotFoundError):
        path.unlink()
    listener = socket.socket(socket.AF_UNIX)
    try:
        listener.bind(str(path))
        os.chmod(path, 0o600)
        listener.listen(16)
    except OSError:
        listener.close()
        raise
    return listener, LocalAddress(path=str(path), key=key)
