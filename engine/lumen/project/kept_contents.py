"""What files held when they were read last: one that nobody has touched since is not read again."""

import os
import stat
import time
from pathlib import Path
from typing import NamedTuple

from lumen.upkeep.regular_files import read_regular

SETTLED_NS = 2_000_000_000
"""How long ago a file was changed whose next change certainly shows in its times [ns]: some disks count in seconds."""


class _Kept(NamedTuple):
    identity: tuple[int, ...]
    content: bytes


class KeptContents:
    """Contents by path, for who reads the same files each second.

    A plain file with the same number, size and times as before, which were settled then, has the same content.
    """

    def __init__(self) -> None:
        self._kept: dict[Path, _Kept] = {}

    def read(self, path: Path, entry: os.stat_result, most: int) -> bytes:
        """What the file holds that `entry` is about; raises what `read_regular` raises."""
        identity = (entry.st_dev, entry.st_ino, entry.st_size, entry.st_mtime_ns, entry.st_ctime_ns)
        kept = self._kept.get(path)
        if kept and kept.identity == identity:
            return kept.content
        content = read_regular(path, most)
        newest = max(entry.st_mtime_ns, entry.st_ctime_ns)
        if stat.S_ISREG(entry.st_mode) and newest + SETTLED_NS < time.time_ns() and len(content) == entry.st_size:
            self._kept[path] = _Kept(identity, content)
        else:
            self._kept.pop(path, None)
        return content
