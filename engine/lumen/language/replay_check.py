"""The check of saved files against recorded visits before they are used."""

from dataclasses import dataclass
from typing import Literal

CheckMode = Literal["", "warn", "refuse"]

DEFAULT_BUDGET = 5.0
MAX_BUDGET = 30.0
"""The longest time that saved files may wait for the check [s]."""


@dataclass(frozen=True, slots=True)
class ReplayCheck:
    """The settings of the check, which plays recorded visits with the saved files, the newest first."""

    mode: CheckMode = ""
    """`warn` reports visits that would differ, `refuse` also rejects the files; empty for no check."""
    budget: float = DEFAULT_BUDGET
    """The maximum time of a check [s]."""
