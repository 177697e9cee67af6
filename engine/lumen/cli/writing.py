"""A result: into a file where one is named, else to the terminal."""

from pathlib import Path

from lumen.errors import UsageError


def write_result(text: str, output: Path | None) -> None:
    """Write or print the text. Raises UsageError where the file can't be written."""
    if output is None:
        print(text, end="")
        return
    try:
        output.write_text(text, encoding="utf-8")
    except OSError as error:
        raise UsageError(f"can't write {output}: {(error.strerror or str(error)).lower()}") from None
    print(f"wrote {output}")
