"""The recorded journals, each entry read and written again: the lines are what they were, to the byte.

A line that differs is written as it was and as it is.
"""

from hashlib import sha256
from pathlib import Path

from tests.golden.adapters import journal_lines
from tests.golden.kept import JOURNALS, journals
from tests.golden.texts import write

SUITE = "test"


def record(folder: Path) -> None:
    """Write a paragraph for each file of a journal."""
    found: list[str] = []
    for files in journals().values():
        for file in files:
            found += paragraph(file)
    write(folder / "lines.txt", found)


def paragraph(file: Path) -> list[str]:
    """Return the header, whether the file is whole, the number of lines, their digest, and the lines that differ."""
    header, whole, lines, again, read = journal_lines(file)
    was = [line + b"\n" for line in lines]
    differs = [f"was {old!r}\nis  {new!r}" for old, new in zip(was, again, strict=True) if old != new]
    all_of_them = sha256(b"".join(again)).hexdigest()
    return [
        f"{file.relative_to(JOURNALS)}: {'whole' if whole else 'cut'}, {len(again)} lines, {all_of_them}",
        header.decode().strip(),
        f"read as they are packed: {read}",
        *differs,
    ]
