"""How long the simulated robot takes to say something, and who else may want to know."""

from typing import Protocol

PAUSE, PER_CHARACTER = 0.4, 0.06
"""How long a text takes to say where nobody says it [s], and each of its characters."""


class Voice(Protocol):
    """Says texts in simulated time."""

    def begin(self, text: str, language: str, now: float) -> float:
        """Say it from `now` [s] on; how long that takes [s]."""
        ...

    def end(self, now: float) -> None:
        """It is over, or was cancelled."""
        ...


class Silence:
    """Says nothing, and takes its time for that."""

    def begin(self, text: str, language: str, now: float) -> float:
        return PAUSE + PER_CHARACTER * len(text)

    def end(self, now: float) -> None:
        """Nothing was to be heard."""
