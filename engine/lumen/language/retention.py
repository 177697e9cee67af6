"""Settings of the journal of inputs and of recordings: for how long they are kept, and how much of them."""

from dataclasses import dataclass

SHORTEST_RING, LONGEST_RING = 10.0, 7200.0
"""The limits of the ring of recordings [s]: two hours with the camera are some 600 MB."""


@dataclass(frozen=True, slots=True)
class JournalRetention:
    """The limits of the journal, beyond which the oldest entries are deleted; if a limit is 0, no journal is kept."""

    keep: float = 30.0
    """The maximum age of an entry [days]."""
    size: float = 2000.0
    """The maximum size of the journal [MB]."""

    @property
    def wanted(self) -> bool:
        """True if a journal is kept."""
        return self.keep > 0 and self.size > 0


@dataclass(frozen=True, slots=True)
class RecordingSettings:
    """The settings of automatic recordings of the bus."""

    ring: float = 0.0
    """The length of the past that is always available [s]; 0 for none."""
    keep: float = 30.0
    """The time that the recording of an incident is kept [days]."""
    size: float = 5000.0
    """The maximum size of all kept recordings [MB]."""
    camera: bool = True
    """True if recordings contain the camera's images."""
