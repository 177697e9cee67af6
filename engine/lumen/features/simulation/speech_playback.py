"""The simulated robot's speech: how long it takes, and an interface for a real voice."""

from typing import Protocol

from lumen.language.gestures import WordTime
from lumen.robot.command_table import speech_duration


class SpeechPlayback(Protocol):
    """Speaks texts in simulated time."""

    words: tuple[WordTime, ...]
    """The times at which the words of the last text begin, if the voice reports them."""

    def begin(self, text: str, language: str, volume: float, now: float) -> float:
        """Begin to speak at `now` [s] with a `volume` from 0 to 1; return the duration [s]."""
        ...

    def end(self, now: float) -> None:
        """End the speech: it is finished or was cancelled."""
        ...


class SilentPlayback:
    """Speaks without sound, as long as the text would take."""

    words: tuple[WordTime, ...] = ()

    def begin(self, text: str, language: str, volume: float, now: float) -> float:
        """Return the usual duration of the text [s]."""
        return speech_duration(text)

    def end(self, now: float) -> None:
        """Do nothing: there was no sound."""
