"""What goes over the socket: JSON arrays, each behind its length; and the proof that both sides know the key."""

import hashlib
import hmac
import json
import secrets
import struct
from collections.abc import Iterator
from typing import Any

from lumen.bus.bodies import MAX_BODY_BYTES

MAX_FRAME_BYTES = MAX_BODY_BYTES + 4_096
"""How long a frame may be [bytes]: a body and what stands around it."""
RECEIVE_BYTES = 1 << 16
"""What is read from the socket at once."""
CLIENT, SERVER = "guest", "door"
"""The two sides, as they stand in a proof; a process of an older Lumen must come to the same."""

_LENGTH = struct.Struct(">I")


class BadFrameError(Exception):
    """What came is no frame, or none that fits here: the connection ends."""


def frame(*words: Any) -> bytes:
    """The words, which are JSON data, as they cross the wire."""
    data = json.dumps(words, ensure_ascii=False, separators=(",", ":")).encode("utf-8", "surrogatepass")
    return _LENGTH.pack(len(data)) + data


def framed(head: list[Any], body: bytes) -> bytes:
    """A frame of `head` that ends with a body that is JSON already."""
    data = json.dumps(head, ensure_ascii=False)[:-1].encode() + b"," + body + b"]"
    return _LENGTH.pack(len(data)) + data


def unframed(buffer: bytearray) -> Iterator[list[Any]]:
    """The frames that have come as a whole, taken from the front of the buffer; raises BadFrameError."""
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
    """A question that was never asked before."""
    return secrets.token_hex(16)


def proof(key: str, side: str, question: str) -> str:
    """The answer to a question that takes the key; each side's answers differ, so that none can be sent back."""
    return hmac.new(key.encode(), f"{side} {question}".encode(), hashlib.sha256).hexdigest()


def proves(given: object, key: str, side: str, question: str) -> bool:
    """Whether that is the proof, compared in constant time."""
    return isinstance(given, str) and hmac.compare_digest(given.encode(), proof(key, side, question).encode())
