"""Folders and files of Lumen that hold names, pictures or keys."""

import os
from contextlib import suppress
from pathlib import Path

IGNORE_FILE = ".gitignore"
_IGNORING = b"# Written by Lumen: here are names, pictures and keys.\n*\n"

NO_LINK = getattr(os, "O_NOFOLLOW", 0)
"""The flag that refuses links: a link in a foreign project may lead to any of the user's files."""


def private_folder(folder: Path) -> None:
    """Make a folder if it is missing, with a .gitignore that excludes all of it from version control.

    An existing .gitignore is kept. Raises OSError if the folder can't be made.
    """
    folder.mkdir(parents=True, exist_ok=True)
    with suppress(OSError):
        handle = os.open(folder / IGNORE_FILE, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o644)
        with open(handle, "wb", buffering=0) as file:
            file.write(_IGNORING)


def write_private(path: Path, content: bytes, *, durable: bool = False) -> None:
    """Write a file for its owner only, completely or not at all. Raises OSError.

    A crash of the process loses nothing. After a power cut the previous file may come back, unless `durable` forces the
    content to the disk.
    """
    draft = path.with_name(f"{path.name}.new")
    with open(os.open(draft, os.O_WRONLY | os.O_CREAT | os.O_TRUNC | NO_LINK, 0o600), "wb") as file:
        file.write(content)
        if durable:
            file.flush()
            os.fsync(file.fileno())
    os.replace(draft, path)
