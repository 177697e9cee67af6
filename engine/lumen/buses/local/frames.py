"""What crosses the door: JSON arrays, each behind its length; and the proof that both sides know the key."""

import hashlib
import hmac
import json
import secrets
import struct
from collections.abc import Iterator
from typing import Any

from lumen.buses.bodies import MAX_BYTES

MOST = MAX_BYTES + 4_096
"""Bytes of a frame: a body and what is said around it."""

_LENGTH = struct.Struct(">I")


class BadFrameError(Exception):
    """Who sent this does not speak our language: the connection ends."""


def frame(*words: Any) -> bytes:
    """The words, which are JSON data, as they cross the wire."""
    data = json.dumps(words, ensure_ascii=False, separators=(",", ":")).encode("utf-8", "surrogatepass")
    return _LENGTH.pack(len(data)) + data


def framed(head: list[Any], body: bytes) -> bytes:
    """A frame that ends with a body that is JSON already."""
    data = json.dumps(head, ensure_ascii=False)[:-1].encode() + b"," + body + b"]"
    return _LENGTH.pack(len(data)) + data


def unframed(buffer: bytearray) -> Iterator[list[Any]]:
    """The frames that have come as a whole, taken from the front of the buffer; raises BadFrameError."""
    while len(buffer) >= _LENGTH.size:
        (length,) = _LENGTH.unpack_from(buffer)
        if length > MOST:
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
        raise BadFrameError("a frame is a list that begins with a word")
    return words


def nonce() -> str:
    return secrets.token_hex(16)


def proof(key: str, side: str, asked: str) -> str:
    """What only who knows the key can answer to `asked`; each side's answers differ, so that none can be sent back."""
    return hmac.new(key.encode(), f"{side} {asked}".encode(), hashlib.sha256).hexdigest()


def proves(given: object, key: str, side: str, asked: str) -> bool:
    return isinstance(given, str) and hmac.compare_digest(given.encode(), proof(key, side, asked).encode())
