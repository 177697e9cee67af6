"""Files of other tools, for the verbs that read them."""

import stat
from pathlib import Path

from lumen.errors import UsageError
from lumen.formats.conversion_findings import MAX_FILE_BYTES
from lumen.language.diagnostics import Diagnostic


def foreign_content(path: Path) -> bytes:
    """What the file holds; raises UsageError where it can't be read, or is too large to be one of these."""
    try:
        if not stat.S_ISREG(path.stat().st_mode) and not path.is_dir():
            raise UsageError(f"can't read {path}: it is a device or a pipe, not a file")
        with path.open("rb") as file:
            content = file.read(MAX_FILE_BYTES + 1)
    except OSError as error:
        raise UsageError(f"can't read {path}: {(error.strerror or str(error)).lower()}") from None
    if len(content) > MAX_FILE_BYTES:
        raise UsageError(f"{path} is larger than {MAX_FILE_BYTES // 1_000_000} MB: too large to be imported")
    return content


def one_line(diagnostic: Diagnostic) -> str:
    """A finding as the reason why a command can't run."""
    hint = f" ({diagnostic.hint})" if diagnostic.hint else ""
    return f"{diagnostic.place}: {diagnostic.message}{hint}"
