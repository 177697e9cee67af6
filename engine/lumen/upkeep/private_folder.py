"""Folders and files of ours that hold names, pictures or keys."""

import os
from contextlib import suppress
from pathlib import Path

IGNORE_FILE = ".gitignore"
_IGNORING = b"# Written by Lumen: here are names, pictures and keys.\n*\n"

NO_LINK = getattr(os, "O_NOFOLLOW", 0)
"""The flag that refuses a link: one in a project may lead to any file of the user, and a stranger may have sent it."""


def private_folder(folder: Path) -> None:
    """Make the folder where it is missing, and have version control pass it over: `git add -A` takes nothing of it.

    What stands in its .gitignore already stays. Raises OSError where the folder can't be made.
    """
    folder.mkdir(parents=True, exist_ok=True)
    with suppress(OSError):
        handle = os.open(folder / IGNORE_FILE, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o644)
        with open(handle, "wb", buffering=0) as file:
            file.write(_IGNORING)


def write_private(path: Path, content: bytes, *, durable: bool = False) -> None:
    """Write a file for its owner alone, as a whole or not at all. Raises OSError.

    A crash of the process loses nothing. A power cut may bring back the file before, unless `durable` forces the
    content to the disk.
    """
    draft = path.with_name(f"{path.name}.new")
    with open(os.open(draft, os.O_WRONLY | os.O_CREAT | os.O_TRUNC | NO_LINK, 0o600), "wb") as file:
        file.write(content)
        if durable:
            file.flush()
            os.fsync(file.fileno())
    os.replace(draft, path)
