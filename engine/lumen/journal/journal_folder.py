"""The files of a journal of inputs: in a folder, in the order of their positions, and no more than are wanted."""

import os
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import BinaryIO

from lumen.errors import JournalError
from lumen.journal.journal_file import JOURNAL_SUFFIX, JournalHeader, header_of, read_journal
from lumen.language.iso_time import file_stamp
from lumen.upkeep.private_folder import NO_LINK, private_folder

JOURNAL_FOLDER = "journal"
REHEARSED_FOLDER = "rehearsed"
"""Below it: the runs of stories and programs, which push out no visit."""
DAY = 86400.0
MEGABYTE = 1_000_000


class JournalFolder:
    """Files of a journal, kept for `keep` days, and `size` MB together; the newest stays in any case."""

    def __init__(self, folder: Path, keep: float, size: float) -> None:
        self.folder, self._keep, self._size = folder, keep, size

    def files(self) -> list[Path]:
        """The files, the oldest first."""
        return sorted(self.folder.glob(f"*{JOURNAL_SUFFIX}"))

    def next_position(self) -> int:
        """The position that follows the last one that is kept. Raises JournalError where that can't be read."""
        for file in reversed(self.files()):
            try:
                content = read_journal(file)
            except JournalError:
                continue
            return content.header.first + len(content.entries)
        return 0

    def open(self, header: JournalHeader) -> BinaryIO:
        """A new file that begins with this header; one of this run that has no entry yet gives way. Raises OSError."""
        private_folder(self.folder)
        name = f"{header.first:012d}-{file_stamp(header.began)}-{header.run[:8]}{JOURNAL_SUFFIX}"
        handle = os.open(self.folder / name, os.O_WRONLY | os.O_CREAT | os.O_TRUNC | os.O_APPEND | NO_LINK, 0o600)
        file = open(handle, "wb", buffering=0)  # noqa: SIM115  it is closed where it is written
        file.write(header.line())
        return file

    def prune(self, now: float) -> None:
        """Delete what is older than wanted, and the oldest of what is more than wanted."""
        left = 0
        for number, file in enumerate(reversed(self.files())):
            with suppress(OSError):
                said = file.stat()
                left += said.st_size
                if number and (now - said.st_mtime > self._keep * DAY or left > self._size * MEGABYTE):
                    file.unlink()

    def clear(self) -> None:
        """Delete all files."""
        for file in self.files():
            with suppress(OSError):
                file.unlink()


def newest(home: Path) -> Path | None:
    """The file of a home that its run writes, or wrote last."""
    return max((home / JOURNAL_FOLDER).glob(f"*{JOURNAL_SUFFIX}"), default=None)


def named_bundles(home: Path) -> set[str]:
    """The hashes of the bundles that the kept journals of a home need; those that can't be read need none."""
    return {header.bundle for _, header in headers(home / JOURNAL_FOLDER)}


def headers(folder: Path) -> Iterator[tuple[Path, JournalHeader]]:
    """The files of a journal and of what was rehearsed beside it, each with its header, where it can be read."""
    for file in sorted(folder.rglob(f"*{JOURNAL_SUFFIX}")):
        with suppress(JournalError):
            yield file, header_of(file)
