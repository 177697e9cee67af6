"""Reading a file that may be anything: a pipe, a device, a link to somewhere else, or larger than memory."""

import errno
import os
import stat
from pathlib import Path

from lumen.upkeep.private_folder import NO_LINK

MEGABYTE = 1_000_000


def read_regular(path: Path, most: int, *, follow: bool = True) -> bytes:
    """What a plain file of at most so many bytes holds; raises OSError, whose `strerror` is the reason in words.

    Nothing is waited for: of what is no plain file nothing is read. Without `follow` a link is refused, too.
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
