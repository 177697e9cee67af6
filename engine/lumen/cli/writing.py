"""Write results to a file if one is named, else print them."""

from pathlib import Path

from lumen.errors import UsageError
from lumen.upkeep.replacing import replace_file


def write_result(text: str, output: Path | None, *, folders: bool = False) -> None:
    """Write the text to `output` and print that path, or print the text if it is None.

    Missing folders are created if `folders`. Raises UsageError if the file can't be written.
    """
    if output is None:
        print(text, end="")
        return
    write_file(text.encode("utf-8", "replace"), output, folders=folders)
    print(f"wrote {output}")


def write_file(content: bytes, output: Path, *, folders: bool = False) -> None:
    """Write a file atomically; `folders` creates missing folders.

    Raises UsageError if the writing fails; an existing file is then unchanged.
    """
    try:
        if folders:
            output.parent.mkdir(parents=True, exist_ok=True)
        replace_file(output, content)
    except OSError as error:
        raise UsageError(f"can't write {output}: {(error.strerror or str(error)).lower()}") from None
