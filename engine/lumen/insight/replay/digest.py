"""The digest of a step in eight digits: equal if states left and entered, commands and snapshot are equal."""

import json
from collections.abc import Mapping, Set
from typing import Any
from zlib import crc32

from lumen.language.command_data import command_data
from lumen.statechart import Snapshot, Step

_encode = json.JSONEncoder(sort_keys=True, separators=(",", ":"), default=lambda value: _plain(value)).encode


class StepDigest:
    """Computes the digests of successive steps; parts that a step left unchanged are not encoded again.

    The digest is equal in every process, and for a snapshot that was read from the disk.
    """

    def __init__(self) -> None:
        self._seen: dict[str, tuple[Any, int]] = {}

    def __call__(self, step: Step) -> str:
        """Return eight hexadecimal digits. Raises TypeError or ValueError if a part of the step is not JSON data."""
        found = 0
        if step.exited or step.entered or step.commands:
            made = [step.exited, step.entered, [command_data(command) for command in step.commands]]
            found = crc32(_encode(made).encode("utf-8", "surrogatepass"))
        return f"{crc32(b'%d' % self._standing(step.snapshot), found):08x}"

    def _standing(self, snapshot: Snapshot) -> int:
        found = 0
        for name, value in zip(Snapshot._fields, snapshot, strict=True):
            seen = self._seen.get(name)
            if seen is None or seen[0] is not value:
                plain = float(value) if name in _TIMES else value
                seen = self._seen[name] = value, crc32(_encode(plain).encode("utf-8", "surrogatepass"))
            found = (found * 31 + seen[1]) & 0xFFFFFFFFFFFF
        return found


_TIMES = ("at", "epoch")


def _plain(value: Any) -> Any:
    if isinstance(value, Set):
        return sorted(value)
    if isinstance(value, Mapping):
        return dict(value)
    raise TypeError(f"a {type(value).__name__} is not JSON data")
