"""The check of saved files against recorded visits before they are used."""

from dataclasses import dataclass
from typing import Literal

CheckMode = Literal["", "warn", "refuse"]

DEFAULT_BUDGET = 5.0
MAX_BUDGET = 30.0
"""The longest time that saved files may wait for the check [s]."""


@dataclass(frozen=True, slots=True)
class ReplayCheck:
    """`warn` reports what would differ, `refuse` also rejects such files; empty checks nothing.

    The newest visits are played first, for at most `budget` [s].
    """

    mode: CheckMode = ""
    budget: float = DEFAULT_BUDGET
