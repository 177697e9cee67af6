"""Frames on the socket: JSON arrays, each preceded by its length; and the proof that both sides have the key."""

import hashlib
import hmac
import json
import secrets
import struct
from collections.abc import Iterator
from typing import Any

from lumen.bus.bodies import MAX_BODY_BYTES

MAX_FRAME_BYTES = MAX_BODY_BYTES + 4_096
"""Longest frame [bytes]: a body and its surroundings."""
RECEIVE_BYTES = 1 << 16
"""The greatest number of bytes that are read from the socket at once."""
CLIENT, SERVER = "guest", "door"
"""The names of the two sides in a proof; they must stay the same for compatibility with older versions."""

_LENGTH = struct.Struct(">I")


class BadFrameError(Exception):
    """Received data is not a frame, or not one that is valid at this point; the connection ends."""


def frame(*words: Any) -> bytes:
    """Return words, which must be JSON data, as a frame."""
    data = json.dumps(words, ensure_ascii=False, separators=(",", ":")).encode("utf-8", "surrogatepass")
    return _LENGTH.pack(len(data)) + data


def framed(head: list[Any], body: bytes) -> bytes:
    """Return a frame of `head` followed by a body that is already JSON."""
    data = json.dumps(head, ensure_ascii=False)[:-1].encode() + b"," + body + b"]"
    return _LENGTH.pack(len(data)) + data


def unframed(buffer: bytearray) -> Iterator[list[Any]]:
    """Remove the complete frames from the front of the buffer, and yield them. Raises BadFrameError for a bad one."""
    while len(buffer) >= _LENGTH.size:
        (length,) = _LENGTH.unpack_from(buffer)
        if length > MAX_FRAME_BYTES:
            raise BadFrameError(f"a frame of {length} bytes")
        if len(buffer) < _LENGTH.size + length:
            return
        data = bytes(buffer[_LENGTH.size : _LENGTH.size + length])
        del buffer[: _LENGTH.size + length]
        yield _words(data)


def _words(data: bytes) -> list[Any]:
    try:
        words = json.loads(data)
    except (ValueError, RecursionError) as error:
        raise BadFrameError(str(error)) from None
    if not isinstance(words, list) or not words or not isinstance(words[0], str):
        raise BadFrameError("a frame must be a list that begins with a word")
    return words


def nonce() -> str:
    """Return a random question that was never used before."""
    return secrets.token_hex(16)


def proof(key: str, side: str, question: str) -> str:
    """Return the answer to a question, which requires the key; each side's answers differ, so none can be sent back."""
    return hmac.new(key.encode(), f"{side} {question}".encode(), hashlib.sha256).hexdigest()


def proves(given: object, key: str, side: str, question: str) -> bool:
    """Return whether `given` is the proof, compared in constant time."""
    return isinstance(given, str) and hmac.compare_digest(given.encode(), proof(key, side, question).encode())
