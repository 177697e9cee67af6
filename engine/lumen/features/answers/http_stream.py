"""A POST over HTTP with a streamed response, limited in size and time, even if the server sends slowly."""

import io
import json
import socket
import ssl
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from http.client import HTTPException, HTTPResponse
from typing import Any, cast
from urllib.parse import urlsplit

from lumen.errors import ModuleError

MAX_BYTES = 200_000
"""The maximum size of a response with its headers [bytes]; no answer of two sentences needs more."""
LOOK = 0.1
"""The time between two checks of whether the response is still wanted [s]."""
PIECE = 4_096


@contextmanager
def answered(
    url: str, body: Any, secret: str, deadline: float, wanted: Callable[[], bool], most: int = MAX_BYTES
) -> Iterator[tuple[str, Iterator[bytes]]]:
    """Send `body` as JSON, and yield the response's media type and an iterator of its bytes.

    Redirects are not followed. Raises ModuleError, never with the key in its message: at `deadline` (`time.monotonic`),
    if `wanted` returns False, for more than `most` bytes with headers, a status other than 200, an invalid URL or an
    unreachable server.
    """
    parts = urlsplit(url)
    connection: socket.socket | None = None
    try:
        if parts.scheme not in ("http", "https") or not parts.hostname:
            raise ModuleError("the address of the language model must begin with http:// or https://")
        connection = _connected(parts.scheme, parts.hostname, parts.port, deadline)
        connection.settimeout(max(deadline - time.monotonic(), LOOK))
        connection.sendall(_request(parts.netloc.rpartition("@")[2], parts.path or "/", parts.query, body, secret))
        response = HTTPResponse(cast(socket.socket, _Bounded(connection, deadline, wanted, most)), method="POST")
        response.begin()
        if response.status != 200:
            raise ModuleError(f"the language model answers {response.status} {response.reason[:60]}".rstrip())
        yield response.headers.get_content_type(), _pieces(response)
    except ssl.SSLCertVerificationError:
        raise ModuleError("this machine does not trust the language model's certificate") from None
    except TimeoutError:
        raise ModuleError("the language model did not answer in time") from None
    except (OSError, HTTPException, ValueError) as error:
        raise ModuleError(f"the language model cannot be reached: {type(error).__name__}") from None
    finally:
        if connection:
            connection.close()


def _connected(scheme: str, host: str, port: int | None, deadline: float) -> socket.socket:
    left = max(deadline - time.monotonic(), LOOK)
    plain = socket.create_connection((host, port or (443 if scheme == "https" else 80)), timeout=left)
    if scheme == "http":
        return plain
    try:
        return ssl.create_default_context().wrap_socket(plain, server_hostname=host)
    except BaseException:
        plain.close()
        raise


def _request(host: str, path: str, query: str, body: Any, secret: str) -> bytes:
    data = json.dumps(body).encode()
    lines = [
        f"POST {path}{'?' if query else ''}{query} HTTP/1.1", f"Host: {host}", "Content-Type: application/json",
        "Accept: text/event-stream, application/json", f"Content-Length: {len(data)}", "User-Agent: lumen",
        "Connection: close", *([f"Authorization: Bearer {secret}"] if secret else []), "", "",
    ]  # fmt: skip
    return "\r\n".join(lines).encode("ascii") + data


def _pieces(response: HTTPResponse) -> Iterator[bytes]:
    while piece := response.read1(PIECE):
        yield piece


class _Bounded:
    """A connection for HTTPResponse to read from, with limits of size and time, while the response is wanted."""

    def __init__(self, connection: socket.socket, deadline: float, wanted: Callable[[], bool], most: int) -> None:
        self._reader = _BoundedReader(connection, deadline, wanted, most)

    def makefile(self, mode: str) -> io.BufferedReader:
        """Return a buffered reader of the connection that enforces the limits; `mode` is ignored."""
        return io.BufferedReader(self._reader)


class _BoundedReader(io.RawIOBase):
    def __init__(self, connection: socket.socket, deadline: float, wanted: Callable[[], bool], most: int) -> None:
        self._connection, self._deadline, self._wanted = connection, deadline, wanted
        self._most = self._left = most

    def readable(self) -> bool:
        """Return True, as `io.BufferedReader` requires."""
        return True

    def readinto(self, buffer: Any) -> int:
        """Read into the buffer, and return the number of bytes, 0 at the end.

        Raises TimeoutError at the deadline, ModuleError for too much data or an unwanted response.
        """
        while self._wanted():
            left = self._deadline - time.monotonic()
            if left <= 0:
                raise TimeoutError
            self._connection.settimeout(min(left, LOOK))
            try:
                count = self._connection.recv_into(buffer)
            except TimeoutError:
                continue
            self._left -= count
            if self._left < 0:
                raise ModuleError(f"the language model sent more than {self._most} bytes")
            return count
        raise ModuleError("the answer of the language model is no longer needed")
