"""How long the simulated robot takes to say something, and who else may want to know."""

from typing import Protocol

from lumen.language.gestures import WordTime
from lumen.robot.command_table import speech_duration


class SpeechPlayback(Protocol):
    """Says texts in simulated time; `words` tells when those of the last one begin, where the voice knows."""

    words: tuple[WordTime, ...]

    def begin(self, text: str, language: str, volume: float, now: float) -> float:
        """Say it from `now` [s] on, with a `volume` from 0 to 1; how long that takes [s]."""
        ...

    def end(self, now: float) -> None:
        """It is over, or was cancelled."""
        ...


class SilentPlayback:
    """Says nothing, and takes its time for that."""

    words: tuple[WordTime, ...] = ()

    def begin(self, text: str, language: str, volume: float, now: float) -> float:
        return speech_duration(text)

    def end(self, now: float) -> None:
        """Nothing was to be heard."""
