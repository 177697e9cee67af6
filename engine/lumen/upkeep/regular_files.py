"""Read a path safely, although it may be a pipe, a device, a link to another place, or a file larger than memory."""

import errno
import os
import stat
from pathlib import Path

from lumen.upkeep.own_folders import NO_LINK

MEGABYTE = 1_000_000


def read_regular(path: Path, most: int, *, follow: bool = True) -> bytes:
    """Return the content of a regular file of at most `most` bytes, without blocking.

    Raises OSError, with the reason as its `strerror`, for a larger file or anything else; without `follow` also for a
    link.
    """
    flags = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
    handle = os.open(path, flags if follow else flags | NO_LINK)
    try:
        mode = os.fstat(handle).st_mode
        if stat.S_ISDIR(mode):
            raise OSError(errno.EISDIR, "it is a folder")
        if not stat.S_ISREG(mode):
            raise OSError(errno.EINVAL, "it is a device or a pipe, not a file")
        with os.fdopen(handle, "rb", closefd=False) as file:
            content = file.read(most + 1)
    finally:
        os.close(handle)
    if len(content) > most:
        raise OSError(errno.EFBIG, f"it is larger than {most // MEGABYTE} MB")
    return content
