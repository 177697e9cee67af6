"""Combines the findings of several robots."""

from collections.abc import Sequence

from lumen.language.diagnostics import Diagnostic

NEEDED_ONCE = ("unused-", "idle-", "silent-", "unreachable-")
"""The beginnings of codes about parts that need to be used by only one robot."""


def together(views: Sequence[Sequence[Diagnostic]]) -> tuple[Diagnostic, ...]:
    """Return the findings of all robots, each once, sorted; findings in NEEDED_ONCE only if all robots have them."""
    counted: dict[Diagnostic, int] = {}
    for view in views:
        for diagnostic in dict.fromkeys(view):
            counted[diagnostic] = counted.get(diagnostic, 0) + 1
    found = [d for d, count in counted.items() if count == len(views) or not d.code.startswith(NEEDED_ONCE)]
    return tuple(sorted(found, key=lambda d: (d.place, d.code, d.message)))
