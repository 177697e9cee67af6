"""Bodies as DMX channels, and a universe of channels as an sACN packet (ANSI E1.31-2018)."""

import struct
from typing import Any

from lumen.errors import ModuleError
from lumen.project.message_fields import SchemaField

CHANNELS = 512
PORT = 5568
"""The UDP port of sACN (E1.31, 9.2)."""
PRIORITY = 100
"""The default priority (E1.31, 6.2.3); a receiver uses the source with the highest priority."""
FULL = 255
_LAYOUT = struct.Struct(">HH12sHI16sHI64sBHBBHHBBHHH")
_TERMINATED = 0x40


def channel_level(value: Any, field: SchemaField) -> int:
    """Map a value, limited to the field's range, to a level from 0 to 255; True is 255, False is 0.

    Raises ModuleError if the value is neither a number nor a boolean.
    """
    if isinstance(value, bool):
        return FULL * value
    if not isinstance(value, int | float):
        raise ModuleError(f"`{field.name}` must be a number")
    low, high = field.low or 0.0, FULL if field.high is None else field.high
    return round(FULL * min(max((value - low) / (high - low), 0.0), 1.0))


def data_packet(
    levels: bytes, universe: int, sequence: int, *, source: str, component: bytes, terminated: bool = False
) -> bytes:
    """Return a packet of 638 bytes with 512 levels; `component` is the sender's id of 16 bytes, `sequence` 0 to 255.

    `terminated` announces the end of the stream (E1.31, 6.2.6).
    """
    head = _LAYOUT.pack(
        0x0010, 0, b"ASC-E1.17\0\0\0", _length(16), 4, component,
        _length(38), 2, source.encode()[:63], PRIORITY, 0, sequence, _TERMINATED * terminated, universe,
        _length(115), 2, 0xA1, 0, 1, CHANNELS + 1,
    )  # fmt: skip
    return head + b"\0" + levels


def multicast_group(universe: int) -> str:
    """Return the multicast address of a universe (E1.31, 9.3.1)."""
    return f"239.255.{universe >> 8}.{universe & 0xFF}"


def _length(offset: int) -> int:
    """Return the flags and length of a layer that begins at the byte `offset` and ends with the packet."""
    return 0x7000 | (_LAYOUT.size + 1 + CHANNELS - offset)
