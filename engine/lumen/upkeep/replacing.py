"""Save a file completely or not at all: the content is written to a new file, which replaces the old one."""

import errno
import os
import secrets
import shutil
import stat
from contextlib import suppress
from pathlib import Path

_IN_PLACE = (errno.EBUSY, errno.EACCES, errno.EPERM, errno.EROFS)
"""The errors of a folder in which no file can be made, and of a file that can't be replaced because it is a mount."""


def replace_file(path: Path, content: bytes) -> None:
    """Save the content under a path. If that fails, raise OSError and leave an existing file unchanged.

    An existing file keeps its owner and permissions. If the path is a link, the link's target is replaced. Devices and
    pipes are written to directly, and so are files that can't be replaced: those of another owner, mounted ones, and
    those in a read-only folder. A file without write permission raises PermissionError.
    """
    try:
        there = os.stat(path)
    except FileNotFoundError:
        there = None
    system = path.is_absolute() and path.parts[1:2] in (("dev",), ("proc",))
    if (there and not stat.S_ISREG(there.st_mode)) or system:
        path.write_bytes(content)
        return
    target = Path(os.path.realpath(path))
    if there and not os.access(target, os.W_OK):
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(path))
    draft = target.with_name(f".lumen-{secrets.token_hex(6)}.new")
    try:
        _write(draft, content)
        if there:
            _inherit(draft, target, there)
        os.replace(draft, target)
    except OSError as error:
        if not there or error.errno not in _IN_PLACE:
            raise
        _overwrite(target, content)  # of another owner, mounted into a container, or in a folder that can't be written
    finally:
        with suppress(OSError):
            draft.unlink()


def _write(draft: Path, content: bytes) -> None:
    with open(draft, "xb") as file:
        file.write(content)
        file.flush()
        os.fsync(file.fileno())


def _inherit(draft: Path, target: Path, there: os.stat_result) -> None:
    """Give the draft the owner, the permissions and the access lists of the file. Raises OSError on failure."""
    made = os.stat(draft)
    if (made.st_uid, made.st_gid) != (there.st_uid, there.st_gid):
        os.chown(draft, there.st_uid, there.st_gid)
    shutil.copystat(target, draft)
    os.utime(draft)


def _overwrite(target: Path, content: bytes) -> None:
    """Overwrite the file itself, after the disk has reserved the space for it."""
    with open(target, "r+b") as file:
        if content and hasattr(os, "posix_fallocate"):
            os.posix_fallocate(file.fileno(), 0, max(len(content), os.fstat(file.fileno()).st_size))
        file.write(content)
        file.truncate()
