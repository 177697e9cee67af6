"""The interfaces of the simulated robot's voice and sound player, and their silent versions."""

from collections.abc import Callable
from typing import Protocol

from lumen.language.commands import PlaySound
from lumen.language.gestures import WordTime
from lumen.robot.command_table import speech_duration


class SpeechPlayback(Protocol):
    """Speaks texts in simulated time."""

    words: tuple[WordTime, ...]
    """The times at which the last text's words begin; empty if the voice does not report them."""

    def begin(self, text: str, language: str, volume: float, now: float) -> float:
        """Begin to speak at `now` [s] with a `volume` from 0 to 1; return the duration [s]."""
        ...

    def end(self, now: float) -> None:
        """End the finished or cancelled speech at `now` [s]."""
        ...


class SilentPlayback:
    """A silent voice, which lasts as long as the text would."""

    words: tuple[WordTime, ...] = ()

    def begin(self, text: str, language: str, volume: float, now: float) -> float:
        """Return the usual duration of the text [s]."""
        return speech_duration(text)

    def end(self, now: float) -> None:
        """Do nothing: there was no sound."""


class SoundPlayback(Protocol):
    """Plays sound files in simulated time."""

    def play(self, sound: PlaySound, volume: float, now: float) -> Callable[[float], None]:
        """Begin to play at `now` [s] with a `volume` from 0 to 1.

        Return a function that the caller calls with the time [s] at which the sound ends or is stopped.
        """
        ...


class SilentSounds:
    """Plays nothing; the robot still waits for the sound's duration."""

    def play(self, sound: PlaySound, volume: float, now: float) -> Callable[[float], None]:
        """Return a function that does nothing."""
        return lambda now: None


class SoundActivity:
    """The activity of playing a sound for the file's duration."""

    def __init__(self, playback: SoundPlayback, sound: PlaySound, volume: float, now: float) -> None:
        self._end, self._now = playback.play(sound, volume, now), now
        self._until = now + sound.length

    def advance(self, now: float) -> bool:
        """Return True, and stop the player, if the sound has ended by `now` [s]."""
        self._now = now
        if now < self._until:
            return False
        self._end(now)
        return True

    def cancel(self) -> None:
        """Make the next `advance` end the sound."""
        self._until = 0.0
