"""Output of the simulated robot's sounds: on this machine's player, and in the film of the run."""

import shutil
import subprocess
import sys
import wave
from array import array
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Protocol, runtime_checkable

from lumen.language.commands import PlaySound
from lumen.ports import Robot
from lumen.project.files import on_disk
from lumen.robot.bounded_robot import ability
from lumen.run.audio_track import AudioTrack
from lumen.run.sound import Sound

PLAYERS = (("aplay", "-q"), ("paplay",), ("afplay",), ("pw-play",))
"""Programs that play a WAV file; the first that is installed is used."""


def player_here() -> tuple[str, ...] | None:
    """Return the command that plays sounds on this machine, else None."""
    return next((player for player in PLAYERS if shutil.which(player[0])), None)


class Loudspeaker:
    """A player of the sound files of the project in `root`; a missing player is reported once.

    Sounds are also added to `track`, if there is one. With `audible=False` nothing is played here, as in films and in
    runs faster than real time. `close` ends the sounds that still play.
    """

    def __init__(self, root: Path, track: AudioTrack | None = None, *, audible: bool = True) -> None:
        self._root, self._track, self._audible = root, track, audible
        self._player = player_here() if audible else None
        self._told = False
        self._playing: list[subprocess.Popen[bytes]] = []

    def play(self, sound: PlaySound, volume: float, now: float) -> Callable[[float], None]:
        """Start a sound at `now` [s]; return a function that ends it at a later time [s].

        `volume`, from 0 to 1, applies only to the track.
        """
        file = on_disk(self._root, sound.file)
        playing, cut = self._heard(file), None
        if self._track is not None and (found := _mono(file, sound.length)):
            cut = self._track.add(found.at_volume(volume), now)

        def end(then: float) -> None:
            if playing:
                self._hush(playing)
            if cut:
                cut(then)

        return end

    def close(self) -> None:
        """End all sounds."""
        for playing in [*self._playing]:
            self._hush(playing)

    def _hush(self, playing: "subprocess.Popen[bytes]") -> None:
        playing.terminate()
        playing.wait()
        self._playing.remove(playing)

    def _heard(self, file: Path) -> "subprocess.Popen[bytes] | None":
        if self._player is None:
            if self._audible and not self._told:
                self._told = True
                print("No sound player is installed: sounds are silent, but take as long as usual.", file=sys.stderr)
            return None
        try:
            playing = subprocess.Popen([*self._player, str(file)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        except (OSError, ValueError):
            return None
        self._playing.append(playing)
        return playing


def _mono(file: Path, length: float) -> Sound | None:
    """Return the first `length` [s] of a 16-bit WAV, two channels mixed to one; None if the file can't be used."""
    try:
        with wave.open(str(file)) as opened:
            rate, channels = opened.getframerate(), opened.getnchannels()
            if opened.getsampwidth() != 2 or channels not in (1, 2):
                return None
            samples = opened.readframes(min(opened.getnframes(), round(length * rate)))
    except (OSError, EOFError, ValueError, wave.Error):
        return None
    if channels == 2:
        both = array("h", samples[: len(samples) // 4 * 4])
        if sys.byteorder == "big":
            both.byteswap()
        mixed = array("h", ((left + right) // 2 for left, right in zip(both[::2], both[1::2], strict=True)))
        if sys.byteorder == "big":
            mixed.byteswap()
        samples = mixed.tobytes()
    return Sound(rate, samples)


@runtime_checkable
class Sounds(Protocol):
    """A robot that can be given a loudspeaker."""

    def sound_with(self, playback: Loudspeaker) -> None:
        """Play all sounds on a loudspeaker."""
        ...


@contextmanager
def sounding(
    robots: Iterable[Robot], root: Path, track: AudioTrack | None = None, *, audible: bool = True
) -> Iterator[None]:
    """Let the robots that can be given a loudspeaker share one until the block ends; see `Loudspeaker`."""
    loudspeaker = Loudspeaker(root, track, audible=audible)
    for each in robots:
        if able := ability(each, Sounds):
            able.sound_with(loudspeaker)
    try:
        yield
    finally:
        loudspeaker.close()
