"""What is wrong for one of several robots, and what for all of them."""

from collections.abc import Sequence

from lumen.language.diagnostics import Diagnostic

NEEDED_ONCE = ("unused-", "idle-", "silent-", "unreachable-")
"""How the codes begin of what is well as soon as one robot has a use for it."""


def together(views: Sequence[Sequence[Diagnostic]]) -> tuple[Diagnostic, ...]:
    """Everything wrong for any robot, each thing once; that something is unused only where no robot uses it."""
    counted: dict[Diagnostic, int] = {}
    for view in views:
        for diagnostic in dict.fromkeys(view):
            counted[diagnostic] = counted.get(diagnostic, 0) + 1
    found = [d for d, count in counted.items() if count == len(views) or not d.code.startswith(NEEDED_ONCE)]
    return tuple(sorted(found, key=lambda d: (d.place, d.code, d.message)))
