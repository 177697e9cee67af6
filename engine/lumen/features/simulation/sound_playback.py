"""How the simulated robot plays a sound file, and who else may want to hear it."""

from collections.abc import Callable
from typing import Protocol

from lumen.language.commands import PlaySound


class SoundPlayback(Protocol):
    """Plays sound files in simulated time."""

    def play(self, sound: PlaySound, volume: float, now: float) -> Callable[[float], None]:
        """Play it from `now` [s] on, with a `volume` from 0 to 1; what to call with the time of its end."""
        ...


class SilentSounds:
    """Plays nothing: the robot takes its time for that."""

    def play(self, sound: PlaySound, volume: float, now: float) -> Callable[[float], None]:
        return lambda now: None


class SoundActivity:
    """Playing a sound, as long as it takes."""

    def __init__(self, playback: SoundPlayback, sound: PlaySound, volume: float, now: float) -> None:
        self._end, self._now = playback.play(sound, volume, now), now
        self._until = now + sound.length

    def advance(self, now: float) -> bool:
        self._now = now
        if now < self._until:
            return False
        self._end(now)
        return True

    def cancel(self) -> None:
        self._until = 0.0
