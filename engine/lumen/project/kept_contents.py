"""The contents of files when they were last read, so that an unchanged file is not read again."""

import os
import stat
import time
from pathlib import Path
from typing import NamedTuple

from lumen.upkeep.regular_files import read_regular

SETTLED_NS = 2_000_000_000
"""The age of a file's last change above which the next change surely alters its times [ns].

Some file systems store times in whole seconds only.
"""


class _Kept(NamedTuple):
    identity: tuple[int, ...]
    content: bytes


class KeptContents:
    """A cache of contents by path, for callers that read the same files every second.

    A file counts as unchanged if its device, inode, size and times are the same. Only contents of regular files that
    had been unchanged for `SETTLED_NS` are kept.
    """

    def __init__(self) -> None:
        self._kept: dict[str, _Kept] = {}

    def read(self, path: str, entry: os.stat_result, most: int) -> bytes:
        """Return the content of the file at `path`, whose status is `entry`. Raises the same errors as `read_regular`.

        `most` is the maximum size [bytes].
        """
        identity = (entry.st_dev, entry.st_ino, entry.st_size, entry.st_mtime_ns, entry.st_ctime_ns)
        kept = self._kept.get(path)
        if kept and kept.identity == identity:
            return kept.content
        content = read_regular(Path(path), most)
        newest = max(entry.st_mtime_ns, entry.st_ctime_ns)
        if stat.S_ISREG(entry.st_mode) and newest + SETTLED_NS < time.time_ns() and len(content) == entry.st_size:
            self._kept[path] = _Kept(identity, content)
        else:
            self._kept.pop(path, None)
        return content
