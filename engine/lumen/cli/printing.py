"""Print findings on standard output, and compute their exit code."""

import sys
from collections.abc import Sequence

from lumen.cli.streams import hush
from lumen.errors import UsageError
from lumen.language.diagnostics import Severity
from lumen.run.linting.findings import Findings


def verdict(found: Sequence[Findings], *, strict: bool = False) -> int:
    """Return 1 if there is an error, or with `strict` a warning, else 0."""
    return int(any(each.count(Severity.ERROR) or (strict and each.count(Severity.WARNING)) for each in found))


def show(text: str) -> None:
    """Print a text. If a pipe's reader has gone (`lumen lint | head`), return as usual: the exit code still counts.

    Raises UsageError if printing fails for another reason.
    """
    try:
        print(text.encode("utf-8", "replace").decode(), flush=True)
    except OSError as error:
        hush(sys.stdout)
        if not isinstance(error, BrokenPipeError):
            raise UsageError(f"can't print: {(error.strerror or str(error)).lower()}") from None


def clock_time(now: float) -> str:
    """Return a time [s] as `3:07` for 187; rounded first, because a sum of many ticks may be slightly too small."""
    minutes, seconds = divmod(int(round(now, 6)), 60)
    return f"{minutes}:{seconds:02d}"
