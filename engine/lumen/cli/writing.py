"""A result: into a file where one is named, else to the terminal."""

from pathlib import Path

from lumen.errors import UsageError


def write_result(text: str, output: Path | None, *, folders: bool = False) -> None:
    """Write or print the text; `folders` makes those that are missing. Raises UsageError where it can't be written."""
    if output is None:
        print(text, end="")
        return
    try:
        if folders:
            output.parent.mkdir(parents=True, exist_ok=True)
        output.write_text(text, encoding="utf-8")
    except OSError as error:
        raise UsageError(f"can't write {output}: {(error.strerror or str(error)).lower()}") from None
    print(f"wrote {output}")
