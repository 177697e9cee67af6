"""Print diagnostics on a terminal, one line each."""

import sys
from collections.abc import Iterable

from lumen.language.diagnostics import Diagnostic, has_errors


def report(diagnostics: Iterable[Diagnostic]) -> int:
    """Print the diagnostics to standard error; return 1 if one is an error, else 0."""
    found = list(diagnostics)
    for diagnostic in found:
        print(diagnostic, file=sys.stderr)
    return 1 if has_errors(found) else 0
