"""`--voice espeak`: the simulated robot's spoken texts, in a file or on an audio device."""

import logging
import subprocess
import tempfile
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import IO, TypeVar

from lumen.errors import ModuleError
from lumen.features.voice.module import espeak
from lumen.language.gestures import WordTime
from lumen.run.audio_track import AudioTrack
from lumen.run.loudspeaker import player_here
from lumen.run.sound import Sound, save

T = TypeVar("T")
_log = logging.getLogger(__name__)


class Speaker:
    """The simulated robot's voice; each text takes as long as its sound.

    With a `file`, the whole run's sound is written there, each text at its simulated time. Otherwise, the machine's
    own player plays each text. The sound is also added to `heard`, if given. Texts in languages that espeak-ng lacks
    are spoken in `language`. Raises ModuleError if espeak-ng is missing.
    """

    def __init__(self, language: str, file: Path | None, heard: AudioTrack | None = None) -> None:
        self._espeak, self._language, self._file = espeak(), language, file
        self._heard, self._track = heard, list[bytes]()
        self._length = 0
        self.words: tuple[WordTime, ...] = ()
        self._cut: Callable[[float], None] | None = None
        self._saying: tuple[Sound, float] | None = None
        self._player = None if file else player_here()
        self._playing: subprocess.Popen[bytes] | None = None
        self._sheet: IO[bytes] | None = None

    @property
    def mute(self) -> bool:
        """True if the sound is neither written to a file nor played."""
        return self._file is None and self._player is None

    def begin(self, text: str, language: str, volume: float, now: float) -> float:
        """Begin to speak a text at `now` [s] with a `volume` from 0 to 1; return the duration [s]."""
        try:
            sound, self.words = self._espeak.timed(text, language or self._language)
        except ModuleError:
            sound, self.words = self._espeak.timed(text, self._language)
        sound = sound.at_volume(volume)
        self._saying = (sound, now)
        self._cut = self._heard.add(sound, now) if self._heard is not None else None
        if self._player:
            self._play(self._player, sound)
        return sound.duration

    def end(self, now: float) -> None:
        """End the present text, or cut it off, at `now` [s]; do nothing without a text."""
        if self._saying is None:
            return
        (sound, began), self._saying = self._saying, None
        self._hush()
        if self._cut:
            self._cut(now)
        if self._file:
            self._append(sound.until(now - began), began)

    def close(self) -> None:
        """End the present text and write the file, if any. Raises ModuleError if writing fails."""
        if self._saying:
            self.end(self._saying[1] + self._saying[0].duration)
        self._hush()
        if self._file:
            save(self._file, Sound(self._espeak.rate, b"".join(self._track)))

    def _append(self, sound: Sound, at: float) -> None:
        silence = max(0, round(at * sound.rate) - self._length)
        self._track += [bytes(2 * silence), sound.samples]
        self._length += silence + len(sound.samples) // 2

    def _play(self, player: tuple[str, ...], sound: Sound) -> None:
        self._hush()
        with suppress(OSError, ModuleError):
            self._sheet = tempfile.NamedTemporaryFile(suffix=".wav")  # noqa: SIM115  it lasts as long as the sound
            save(Path(self._sheet.name), sound)
            self._playing = subprocess.Popen(
                [*player, self._sheet.name], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
            )

    def _hush(self) -> None:
        if self._playing:
            self._playing.terminate()
            self._playing.wait()
            self._playing = None
        if self._sheet:
            self._sheet.close()
            self._sheet = None
