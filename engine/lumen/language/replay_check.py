"""Whether saved files are tried on the visits that were recorded, before they are taken."""

from dataclasses import dataclass
from typing import Literal

CheckMode = Literal["", "warn", "refuse"]

DEFAULT_BUDGET = 5.0
MAX_BUDGET = 30.0
"""Nobody waits longer for a saved file [s]."""


@dataclass(frozen=True, slots=True)
class ReplayCheck:
    """`warn` says what would be different, `refuse` takes no such files; empty looks at nothing.

    The newest visits are played first, for at most `budget` [s].
    """

    mode: CheckMode = ""
    budget: float = DEFAULT_BUDGET
