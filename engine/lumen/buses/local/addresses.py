"""Where a door is: a small file in the project's own folder, readable by its owner alone."""

import json
import os
import secrets
import socket
import tempfile
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path

from lumen.errors import BusError

LONGEST = 100
"""Bytes that the path of a socket may have: systems allow 104 to 108."""
NAME = "door.sock"
PATIENCE = 5.0


@dataclass(frozen=True)
class Address:
    """`path` of a socket, or where there are none a `port` on loopback; `key` is what both sides have to know."""

    path: str = ""
    port: int = 0
    key: str = ""

    @staticmethod
    def read(file: Path) -> "Address":
        """The address in that file; raises BusError where there is none, or none that can be used."""
        try:
            found = json.loads(file.read_text("utf-8"))
            return Address(str(found["path"]), int(found["port"]), str(found["key"]))
        except FileNotFoundError:
            raise BusError(f"there is no {file}") from None
        except (OSError, ValueError, TypeError, KeyError) as error:
            raise BusError(f"{file} holds no address: {error}") from None

    def write(self, file: Path) -> None:
        """Write it for others of the same user, as a whole or not at all."""
        draft = file.with_name(f"{file.name}.{os.getpid()}")
        with open(os.open(draft, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600), "w", encoding="utf-8") as written:
            json.dump(asdict(self), written)
        os.replace(draft, file)

    def connect(self) -> socket.socket:
        """A connection to whoever listens there; raises OSError where nobody does."""
        wire = socket.socket(socket.AF_UNIX if self.path else socket.AF_INET)
        wire.settimeout(PATIENCE)
        try:
            wire.connect(self.path or ("127.0.0.1", self.port))
        except OSError:
            wire.close()
            raise
        return wire

    def remove(self) -> None:
        """Delete the socket's file, and the folder that was made for it."""
        if self.path:
            with suppress(OSError):
                os.unlink(self.path)
            if Path(self.path).parent.name.startswith("lumen-door-"):
                with suppress(OSError):
                    os.rmdir(Path(self.path).parent)


def listen(folder: Path) -> tuple[socket.socket, Address]:
    """A socket that listens in that folder, and its address; raises OSError where there can be none."""
    key = secrets.token_hex(32)
    if not hasattr(socket, "AF_UNIX"):
        listener = socket.create_server(("127.0.0.1", 0))
        return listener, Address(port=listener.getsockname()[1], key=key)
    if len(os.fsencode(folder / NAME)) > LONGEST:
        folder = Path(tempfile.mkdtemp(prefix="lumen-door-"))
    path = folder / NAME
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
    return listener, Address(path=str(path), key=key)
