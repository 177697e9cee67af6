"""The simulated robot's sound files, and an interface for playing them."""

from collections.abc import Callable
from typing import Protocol

from lumen.language.commands import PlaySound


class SoundPlayback(Protocol):
    """Plays sound files in simulated time."""

    def play(self, sound: PlaySound, volume: float, now: float) -> Callable[[float], None]:
        """Begin to play at `now` [s] with a `volume` from 0 to 1; return a function to call with the time of the end
        [s].
        """
        ...


class SilentSounds:
    """Plays nothing; the robot still waits for the sound's length."""

    def play(self, sound: PlaySound, volume: float, now: float) -> Callable[[float], None]:
        """Return a function that does nothing."""
        return lambda now: None


class SoundActivity:
    """A sound that is playing, for as long as the file lasts."""

    def __init__(self, playback: SoundPlayback, sound: PlaySound, volume: float, now: float) -> None:
        self._end, self._now = playback.play(sound, volume, now), now
        self._until = now + sound.length

    def advance(self, now: float) -> bool:
        """Return True, and stop the player, once the sound has ended."""
        self._now = now
        if now < self._until:
            return False
        self._end(now)
        return True

    def cancel(self) -> None:
        """Make the next `advance` end the sound."""
        self._until = 0.0
