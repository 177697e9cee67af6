"""Delete the data of a person from files of lines of JSON."""

import json
from pathlib import Path

from lumen.errors import ModuleError
from lumen.language.people import PersonName
from lumen.upkeep.own_folders import write_private


def forget_lines(file: Path, person: PersonName) -> int:
    """Delete the lines of a file that name the person; return how many. Raises ModuleError if it can't be written.

    The file is replaced as a whole, and only if there is something to delete.
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
    """Return True if a line of JSON, or one that was cut short, names the person."""
    text = line.decode("utf-8", "replace")
    try:
        return person.is_in(json.loads(text))
    except (ValueError, RecursionError):
        return person.is_named_in(text)
