"""Files of other tools, for the verbs that read them."""

from pathlib import Path

from lumen.errors import UsageError
from lumen.language.diagnostics import Diagnostic
from lumen.project.formats.conversion_findings import MAX_FILE_BYTES
from lumen.upkeep.regular_files import read_regular


def foreign_content(path: Path) -> bytes:
    """What the file holds; raises UsageError where it can't be read, or is too large to be one of these."""
    try:
        return read_regular(path, MAX_FILE_BYTES)
    except (OSError, ValueError) as error:  # a name with a NUL
        reason = getattr(error, "strerror", None) or str(error)
        raise UsageError(f"can't read {path}: {reason[:1].lower()}{reason[1:]}") from None


def one_line(diagnostic: Diagnostic) -> str:
    """A finding as the reason why a command can't run."""
    hint = f" ({diagnostic.hint})" if diagnostic.hint else ""
    return " ".join(f"{diagnostic.place}: {diagnostic.message}{hint}".split())
