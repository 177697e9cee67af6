"""What was found in expressions, kept while all that they may name stays: most of a file is as it was a key ago."""

from collections.abc import Callable, Hashable, Mapping
from typing import Any

from lumen.expressions import ExpressionFinding
from lumen.project.memoization import memoize

MAX_REMEMBERED_FINDINGS = 20_000

Check = Callable[..., list[ExpressionFinding]]
"""`check_expression` or `check_template`."""


class RememberedFindings:
    """The findings of one file's sources, of whoever asks with the same `slot`.

    `names` are what all sources may name, for the checks; `given` is what else the findings depend on.
    """

    def __init__(self, slot: Hashable, names: Mapping[str, Any], given: Any = None) -> None:
        self._names = names
        self._found: dict[Hashable, list[ExpressionFinding]] = memoize(slot, (names, given), dict)

    def of(
        self, check: Check, source: str, site: Hashable, around: Callable[[], Mapping[str, Any]]
    ) -> list[ExpressionFinding]:
        """What a check finds; `site` tells apart what may be named beside, which is `around`."""
        key = check, source, site
        known = self._found.get(key)
        if known is None:
            if len(self._found) >= MAX_REMEMBERED_FINDINGS:
                self._found.clear()
            known = self._found[key] = check(source, **self._names, **around())
        return known
