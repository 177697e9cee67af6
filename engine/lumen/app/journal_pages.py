"""Entries of the journal from a position on, for who asks on the bus: a page at a time."""

from pathlib import Path
from typing import Any

from lumen.errors import JournalError
from lumen.interpreters.replay.entries import entry_data
from lumen.runtime.inputs.journal_file import read_journal
from lumen.runtime.inputs.journal_folder import JOURNAL_FOLDER, headers

MAX_ENTRIES = 500
"""On one page."""


def journal_page(home: Path, position: int, most: int = MAX_ENTRIES) -> dict[str, Any]:
    """Up to `most` entries of the journal in that home, those from `position` on; `next` is where to go on.

    Each is the JSON data of its entry, with its `position`. What is not kept any more is left out, and so is what
    stories played: the first position on the page may be a later one.
    """
    folder = home / JOURNAL_FOLDER
    files = sorted((header.first, file) for file, header in headers(folder) if file.parent == folder)
    begin = max((number for number, (first, _) in enumerate(files) if first <= position), default=0)
    found: list[dict[str, Any]] = []
    for _, file in files[begin:]:
        if len(found) >= most:
            break
        try:
            entries = read_journal(file).entries
        except JournalError:
            continue
        found += [{"position": one.position, **entry_data(one)} for one in entries if one.position >= position]
    found = found[:most]
    return {"entries": found, "next": found[-1]["position"] + 1 if found else position}
