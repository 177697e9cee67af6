"""Cache the findings in expressions while the names in scope are unchanged: an edit changes few expressions."""

from collections.abc import Callable, Hashable, Mapping
from typing import Any

from lumen.expressions import ExpressionFinding
from lumen.project.memoization import memoize

MAX_REMEMBERED_FINDINGS = 20_000

Check = Callable[..., list[ExpressionFinding]]
"""The type of `check_expression` and `check_template`."""


class RememberedFindings:
    """The findings in one file's expressions and templates, shared between callers with the same `slot`.

    `names` are the names in scope for all of them, as keywords of the checks; `given` is any further input.
    """

    def __init__(self, slot: Hashable, names: Mapping[str, Any], given: Any = None) -> None:
        self._names = names
        self._found: dict[Hashable, list[ExpressionFinding]] = memoize(slot, (names, given), dict)

    def of(
        self, check: Check, source: str, site: Hashable, around: Callable[[], Mapping[str, Any]]
    ) -> list[ExpressionFinding]:
        """Return the findings of a check; `around` returns the further names in scope, which `site` identifies."""
        key = check, source, site
        known = self._found.get(key)
        if known is None:
            if len(self._found) >= MAX_REMEMBERED_FINDINGS:
                self._found.clear()
            known = self._found[key] = check(source, **self._names, **around())
        return known
