"""Speech and sound files for Reachy Mini: converts each to a WAV file, and uploads it to the daemon."""

import hashlib
import io
import logging
import tempfile
import wave
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

from lumen.errors import LumenError, RobotError, RobotFailedError, UsageError
from lumen.feature import resolve, table
from lumen.features.reachy.daemon_api import DaemonApi
from lumen.language.diagnostics import did_you_mean
from lumen.project.files import on_disk
from lumen.robot.command_table import speech_duration
from lumen.run.sound import Sound
from lumen.upkeep.ratelimit import OnceLog

MUTE = "none"
"""The voice of a silent robot: a text lasts as long as its speech, which a module on the bus can produce."""
_log = logging.getLogger(__name__)


class LoadedSound(NamedTuple):
    """A sound that the daemon can play."""

    duration: float
    """The sound's duration [s]."""
    file: str = ""
    """The name of its file on the robot; empty for a silent sound."""


class RobotSounds:
    """Makes sounds, and uploads each only once. Its methods wait for the daemon.

    `voice` is a feature's row in `voices`, or `none`; `language` is the default of the texts. Sound files are in the
    folder `root`. `volume`, from 0 to 1, makes sounds quieter before they are uploaded: the robot's own volume does
    not change. Raises UsageError if there is no such voice.
    """

    def __init__(self, api: DaemonApi, voice: str, language: str, root: Path) -> None:
        voices = (*table("voices"), MUTE)
        if voice not in voices:
            raise UsageError(f"there is no voice `{voice}`: {did_you_mean(voice, voices, 'there are')}")
        self._api, self._language, self._root = api, language, root
        self._voice: Callable[..., Any] | None = None if voice == MUTE else resolve(table("voices")[voice])
        self.volume = 1.0
        self._has_media: bool | None = None
        self._uploaded: set[str] = set()
        self._warnings = OnceLog(_log)

    def renew(self) -> None:
        """Forget the uploaded files and whether the daemon plays sounds, because it may have been restarted."""
        self._has_media = None
        self._uploaded.clear()

    def speech(self, text: str, language: str) -> LoadedSound:
        """Return a text as a sound; silent if it is empty, or if the voice or the daemon plays nothing.

        A text that can't be synthesized is silent, too, which is logged once. Raises RobotError if the daemon fails.
        """
        silent = LoadedSound(speech_duration(text))
        if self._voice is None or not text.strip() or not self._media():
            return silent
        try:
            with tempfile.TemporaryDirectory(prefix="lumen-") as folder:
                file = Path(folder) / "said.wav"
                voice = self._voice(self._language, file, None)
                seconds = voice.begin(text, language, self.volume, 0.0)
                voice.end(seconds)
                voice.close()
                return LoadedSound(seconds, self._upload(file.read_bytes()))
        except RobotError:
            raise
        except (LumenError, OSError) as error:
            self._warnings([f"the robot does not speak: {error}"])
            return silent

    def sound(self, file: str, length: float) -> LoadedSound:
        """Return a sound file of the project; silence of `length` [s] if the daemon plays no sounds.

        Raises RobotError if the file can't be read, or the daemon does not accept it.
        """
        if not self._media():
            return LoadedSound(length)
        try:
            return LoadedSound(length, self._upload(quieter(on_disk(self._root, file).read_bytes(), self.volume)))
        except (OSError, wave.Error, EOFError) as error:
            raise RobotFailedError(f"the sound {file} can't be read: {error}") from error

    def _media(self) -> bool:
        """Return whether the daemon has a media server: without it, the daemon answers `ok` and plays nothing."""
        if self._has_media is None:
            status = self._api.request("GET", "/api/media/status")
            self._has_media = isinstance(status, dict) and bool(status.get("available"))
            if not self._has_media:
                self._warnings(["the robot plays no sounds: its daemon runs without its media server"])
        return self._has_media

    def _upload(self, wav: bytes) -> str:
        name = f"lumen-{hashlib.sha256(wav).hexdigest()[:16]}.wav"
        if name not in self._uploaded:
            self._api.upload(name, wav)
            self._uploaded.add(name)
        return name


def quieter(content: bytes, volume: float) -> bytes:
    """Return a 16-bit WAV file with each sample times `volume`; 1 returns `content` unchecked.

    Raises wave.Error or EOFError for other data.
    """
    if volume == 1.0:
        return content
    with wave.open(io.BytesIO(content)) as read:
        parameters, frames = read.getparams(), read.readframes(read.getnframes())
    if parameters.sampwidth != 2:
        raise wave.Error(f"it has {8 * parameters.sampwidth} bits, not 16")
    out = io.BytesIO()
    with wave.open(out, "wb") as written:
        written.setparams(parameters)
        written.writeframes(Sound(parameters.framerate, frames).at_volume(volume).samples)
    return out.getvalue()
