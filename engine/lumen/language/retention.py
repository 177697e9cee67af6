"""How long the journal of inputs is kept, and how much of it."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class JournalRetention:
    """What is older than `keep` days is deleted, and the oldest of what is more than `size` MB; with 0 none is kept."""

    keep: float = 30.0
    size: float = 2000.0

    @property
    def wanted(self) -> bool:
        """Whether there is to be a journal at all."""
        return self.keep > 0 and self.size > 0
