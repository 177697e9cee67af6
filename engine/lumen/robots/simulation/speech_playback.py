"""How long the simulated robot takes to say something, and who else may want to know."""

from typing import Protocol

SPEECH_PAUSE, SPEECH_PER_CHARACTER = 0.4, 0.06
"""How long a text takes to say where nobody says it [s], and each of its characters."""


class SpeechPlayback(Protocol):
    """Says texts in simulated time."""

    def begin(self, text: str, language: str, now: float) -> float:
        """Say it from `now` [s] on; how long that takes [s]."""
        ...

    def end(self, now: float) -> None:
        """It is over, or was cancelled."""
        ...


class SilentPlayback:
    """Says nothing, and takes its time for that."""

    def begin(self, text: str, language: str, now: float) -> float:
        return SPEECH_PAUSE + SPEECH_PER_CHARACTER * len(text)

    def end(self, now: float) -> None:
        """Nothing was to be heard."""
