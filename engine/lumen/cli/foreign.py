"""Read files of other tools, for the subcommands that convert them."""

from pathlib import Path

from lumen.errors import UsageError
from lumen.language.diagnostics import Diagnostic
from lumen.project.formats.conversion_findings import MAX_FILE_BYTES
from lumen.upkeep.regular_files import read_regular


def foreign_content(path: Path) -> bytes:
    """Return the content of a file. Raises UsageError if it can't be read or is larger than MAX_FILE_BYTES."""
    try:
        return read_regular(path, MAX_FILE_BYTES)
    except (OSError, ValueError) as error:  # ValueError: a name with a NUL
        reason = getattr(error, "strerror", None) or str(error)
        raise UsageError(f"can't read {path}: {reason[:1].lower()}{reason[1:]}") from None


def one_line(diagnostic: Diagnostic) -> str:
    """Return a finding on one line, as the reason why a command can't run."""
    hint = f" ({diagnostic.hint})" if diagnostic.hint else ""
    return " ".join(f"{diagnostic.place}: {diagnostic.message}{hint}".split())
