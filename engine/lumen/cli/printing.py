"""Findings on standard output, and whether they count."""

import sys
from collections.abc import Sequence

from lumen.cli.streams import hush
from lumen.errors import UsageError
from lumen.language.diagnostics import Severity
from lumen.run.linting.findings import Findings


def verdict(found: Sequence[Findings], *, strict: bool = False) -> int:
    """1 where something is shown that counts, else 0."""
    return int(any(each.count(Severity.ERROR) or (strict and each.count(Severity.WARNING)) for each in found))


def show(text: str) -> None:
    """Print it; where nobody reads on (`lumen lint | head`), the verdict still counts."""
    try:
        print(text.encode("utf-8", "replace").decode(), flush=True)
    except OSError as error:
        hush(sys.stdout)
        if not isinstance(error, BrokenPipeError):
            raise UsageError(f"can't print: {(error.strerror or str(error)).lower()}") from None


def clock_time(now: float) -> str:
    """`3:07` for 187 [s], which the sum of many ticks may fall short of."""
    minutes, seconds = divmod(int(round(now, 6)), 60)
    return f"{minutes}:{seconds:02d}"
