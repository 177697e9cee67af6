"""A result: into a file where one is named, else to the terminal."""

from pathlib import Path

from lumen.errors import UsageError
from lumen.upkeep.replacing import replace_file


def write_result(text: str, output: Path | None, *, folders: bool = False) -> None:
    """Write or print the text; `folders` makes those that are missing. Raises UsageError where it can't be written."""
    if output is None:
        print(text, end="")
        return
    write_file(text.encode("utf-8", "replace"), output, folders=folders)
    print(f"wrote {output}")


def write_file(content: bytes, output: Path, *, folders: bool = False) -> None:
    """Write a file as a whole. If that fails, raise UsageError and leave an existing file unchanged."""
    try:
        if folders:
            output.parent.mkdir(parents=True, exist_ok=True)
        replace_file(output, content)
    except OSError as error:
        raise UsageError(f"can't write {output}: {(error.strerror or str(error)).lower()}") from None
