"""Lines of text in frames that survive a cut at any byte: what was written before the cut can be read.

A frame is its length and the CRC-32 of its content (4 bytes each, little-endian), and the content: a piece of one
deflate stream that goes on from frame to frame, flushed at the end of each. So text that was said once is short later,
and every frame can be read as soon as it is there.
"""

import struct
import zlib
from collections.abc import Iterator

_HEAD = struct.Struct("<II")
MAX_FRAME_BYTES = 64_000_000
"""A frame that says to be longer is damage."""
MAX_TEXT_BYTES = 64_000_000
"""Of one frame, unpacked."""


class FramePacker:
    """Packs texts into frames of one stream."""

    def __init__(self) -> None:
        self._deflate = zlib.compressobj(6)

    def pack(self, text: bytes) -> bytes:
        """The next frame."""
        content = self._deflate.compress(text) + self._deflate.flush(zlib.Z_SYNC_FLUSH)
        return _HEAD.pack(len(content), zlib.crc32(content)) + content


def unpack(data: bytes, start: int = 0) -> Iterator[tuple[bytes, int]]:
    """The texts of the frames from `start` on, each with where its frame ends, until one is cut or damaged."""
    inflate, at = zlib.decompressobj(), start
    while at + _HEAD.size <= len(data):
        length, crc = _HEAD.unpack_from(data, at)
        content = data[at + _HEAD.size : at + _HEAD.size + length]
        if length > MAX_FRAME_BYTES or len(content) < length or zlib.crc32(content) != crc:
            return
        try:
            text = inflate.decompress(content, MAX_TEXT_BYTES)
        except zlib.error:
            return
        if inflate.unconsumed_tail:
            return
        at += _HEAD.size + length
        yield text, at
