"""Folders of ours that hold names, pictures or keys: whoever makes one makes it here."""

import os
from contextlib import suppress
from pathlib import Path

IGNORE_FILE = ".gitignore"
_IGNORING = b"# Written by Lumen: here are names, pictures and keys.\n*\n"


def private_folder(folder: Path) -> None:
    """Make the folder where it is missing, and have version control pass it over: `git add -A` takes nothing of it.

    What stands in its .gitignore already stays. Raises OSError where the folder can't be made.
    """
    folder.mkdir(parents=True, exist_ok=True)
    with suppress(OSError):
        handle = os.open(folder / IGNORE_FILE, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o644)
        with open(handle, "wb", buffering=0) as file:
            file.write(_IGNORING)
