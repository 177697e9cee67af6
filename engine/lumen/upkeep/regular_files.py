"""Read a path safely, although it may be a pipe, a device, a link to another place, or a file larger than memory."""

import errno
import os
import stat
from pathlib import Path

from lumen.upkeep.own_folders import NO_LINK

MEGABYTE = 1_000_000
FURTHER = 1 << 16
"""The size of the pieces in which the rest of a file is read that is larger than the system says [bytes]."""


def read_regular(path: Path, most: int, *, follow: bool = True) -> bytes:
    """Return the content of a regular file of at most `most` bytes, without blocking.

    Raises OSError, with the reason as its `strerror`, for a larger file or anything else; without `follow` also for a
    link.
    """
    flags = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
    handle = os.open(path, flags if follow else flags | NO_LINK)
    try:
        status = os.fstat(handle)
        if stat.S_ISDIR(status.st_mode):
            raise OSError(errno.EISDIR, "it is a folder")
        if not stat.S_ISREG(status.st_mode):
            raise OSError(errno.EINVAL, "it is a device or a pipe, not a file")
        content = os.read(handle, min(status.st_size, most) + 1)
        while content and len(content) <= most and (more := os.read(handle, FURTHER)):  # until the end, if it has grown
            content += more
    finally:
        os.close(handle)
    if len(content) > most:
        raise OSError(errno.EFBIG, f"it is larger than {most // MEGABYTE} MB")
    return content
