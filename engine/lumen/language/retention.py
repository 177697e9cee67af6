"""How long what happened is kept, and how much of it: the journal of inputs, and recordings."""

from dataclasses import dataclass

SHORTEST_RING, LONGEST_RING = 10.0, 7200.0
"""How much of the past the ring of recordings may hold [s]: two hours with the camera are some 600 MB."""


@dataclass(frozen=True, slots=True)
class JournalRetention:
    """What is older than `keep` days is deleted, and the oldest of what is more than `size` MB; with 0 none is kept."""

    keep: float = 30.0
    size: float = 2000.0

    @property
    def wanted(self) -> bool:
        """Whether there is to be a journal at all."""
        return self.keep > 0 and self.size > 0


@dataclass(frozen=True, slots=True)
class RecordingSettings:
    """What is recorded of the bus without being asked for.

    `ring` is how much of the past is always at hand [s], 0 for none; where something happened it is kept for `keep`
    days and up to `size` MB in all. Without the `camera` no recording has images.
    """

    ring: float = 0.0
    keep: float = 30.0
    size: float = 5000.0
    camera: bool = True
