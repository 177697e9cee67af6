"""Delete the data of a person from files with one JSON text in each line."""

import json
from pathlib import Path

from lumen.errors import ModuleError
from lumen.language.people import PersonName
from lumen.upkeep.own_folders import write_private


def forget_lines(file: Path, person: PersonName) -> int:
    """Delete the lines of a file that name the person, and return their number; 0 if there is no such file.

    The file is replaced as a whole, and only if a line must go. Raises ModuleError if it can't be read or written.
    """
    try:
        lines = file.read_bytes().splitlines(keepends=True)
        kept = [line for line in lines if not line_names(line, person)]
        if len(kept) < len(lines):
            write_private(file, b"".join(kept))
    except FileNotFoundError:
        return 0
    except OSError as error:
        raise ModuleError(f"{file} can't be written: {error.strerror}") from None
    return len(lines) - len(kept)


def line_names(line: bytes, person: PersonName) -> bool:
    """Return True if a line of JSON names the person; a line that was cut short is searched as text."""
    text = line.decode("utf-8", "replace")
    try:
        return person.is_in(json.loads(text))
    except (ValueError, RecursionError):
        return person.is_named_in(text)
