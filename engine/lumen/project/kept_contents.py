"""The contents of files when they were last read, so that an unchanged file is not read again."""

import os
import stat
import time
from pathlib import Path
from typing import NamedTuple

from lumen.upkeep.regular_files import read_regular

SETTLED_NS = 2_000_000_000
"""How old a change must be for the next change to alter the file's times [ns]: some disks count whole seconds."""


class _Kept(NamedTuple):
    identity: tuple[int, ...]
    content: bytes


class KeptContents:
    """Contents by path, for callers that read the same files each second.

    A regular file has the same content if its device, inode, size and times are as before and were settled then.
    """

    def __init__(self) -> None:
        self._kept: dict[Path, _Kept] = {}

    def read(self, path: Path, entry: os.stat_result, most: int) -> bytes:
        """Return the content of the file that `entry` describes, at most `most` bytes. Raises as `read_regular`."""
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
