"""`--voice espeak`: the simulated robot's texts as sound, in a file or on a device."""

import logging
import subprocess
import sys
import tempfile
from collections.abc import Callable
from contextlib import suppress
from math import isfinite
from pathlib import Path
from typing import IO, Protocol, TypeVar, runtime_checkable

from lumen.errors import ModuleError, UsageError
from lumen.feature import Feature, distribution_of, owner, table
from lumen.features.voice.module import espeak
from lumen.language.diagnostics import Diagnostic
from lumen.language.gestures import WordTime
from lumen.ports import Robot
from lumen.project.broken_features import called, faults_reported, need_made, shown
from lumen.robot.bounded_robot import ability
from lumen.robot.command_table import speech_duration
from lumen.run.audio_track import AudioTrack
from lumen.run.loudspeaker import player_here
from lumen.run.setup import Setup
from lumen.run.sound import Sound, save

T = TypeVar("T")
_log = logging.getLogger(__name__)


class RobotVoice(Protocol):
    """A voice of a simulated robot; `words` tells when those of the last text begin, if the voice measures that."""

    words: tuple[WordTime, ...]

    @property
    def mute(self) -> bool:
        """Whether nobody hears anything."""
        ...

    def begin(self, text: str, language: str, volume: float, now: float) -> float:
        """Say a text from `now` [s] on, with a `volume` from 0 to 1; return how long that takes [s]."""
        ...

    def end(self, now: float) -> None:
        """End the text, which is over or was cancelled."""
        ...

    def close(self) -> None: ...


class Speaker:
    """A voice of the simulated robot: each text takes as long as its sound.

    With a `file` it writes the sound of the whole run, each text where it was said in simulated time; else the
    machine's own player gets it. What is said goes into `heard`, too, where that is given. A language that espeak-ng
    lacks is spoken in `language`.
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
        """Whether nobody hears anything."""
        return self._file is None and self._player is None

    def begin(self, text: str, language: str, volume: float, now: float) -> float:
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
        if self._saying is None:
            return
        (sound, began), self._saying = self._saying, None
        self._hush()
        if self._cut:
            self._cut(now)
        if self._file:
            self._append(sound.until(now - began), began)

    def close(self) -> None:
        """Write the file. Raises ModuleError where it can't be."""
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


class AddedVoice:
    """Speaks with `voice`, a row of a feature with that `name`. After its first fault, which is logged, it is silent.

    A silent text takes as long as one of a robot without a voice.
    """

    def __init__(self, voice: RobotVoice, feature: Feature, name: str) -> None:
        self._voice, self._feature, self._name = voice, feature, name
        self.words: tuple[WordTime, ...] = ()
        self._silent = False

    @property
    def mute(self) -> bool:
        """Whether the voice makes no sound."""
        return self._attempt(lambda: bool(self._voice.mute), True)

    def begin(self, text: str, language: str, volume: float, now: float) -> float:
        def begun() -> tuple[float, tuple[WordTime, ...]]:
            return _seconds(self._voice.begin(text, language, volume, now)), tuple(map(_word, self._voice.words))

        silence: tuple[float, tuple[WordTime, ...]] = (speech_duration(text), ())
        seconds, self.words = self._attempt(begun, silence)
        return seconds

    def end(self, now: float) -> None:
        self._attempt(lambda: self._voice.end(now), None)

    def close(self) -> None:
        self._attempt(self._voice.close, None)

    def _attempt(self, call: Callable[[], T], otherwise: T) -> T:
        """Return what a call of the voice returns, or `otherwise` if the voice is or becomes silent."""
        if self._silent:
            return otherwise
        faults: list[Diagnostic] = []
        with faults_reported(self._feature, f"its voice `{self._name}`", faults):
            return call()
        self._silent = True
        _log.error("%s; the robot is silent from now on", faults[0].message)
        return otherwise


def _seconds(value: object) -> float:
    if isinstance(value, int | float) and isfinite(value) and value >= 0:
        return float(value)
    raise TypeError(f"`begin` returned {shown(value)} instead of a number of seconds")


def _word(value: object) -> WordTime:
    if isinstance(value, WordTime):
        return value
    raise TypeError(f"`words` has {shown(value)}, which is no `WordTime`")


@runtime_checkable
class Speaks(Protocol):
    """A robot that can be given a voice."""

    def speak_with(self, voice: RobotVoice) -> None: ...


def voiced(
    chosen: Setup, voice: str, file: Path | None, language: str, track: AudioTrack | None = None
) -> Callable[[], None]:
    """Give the robot the voice that was asked for; what ends it.

    Raises UsageError or ModuleError where that can't be had.
    """
    found = speaker(voice, file, chosen.robot, language, track)
    if found is None:
        return lambda: None
    if speaking := ability(chosen.robot, Speaks):
        speaking.speak_with(found)
    return found.close


def speaker(
    voice: str, file: Path | None, robot: Robot, language: str, track: AudioTrack | None = None
) -> RobotVoice | None:
    """The voice that was asked for; None for none. Raises UsageError or ModuleError where it can't be had."""
    if voice == "none":
        if file:
            raise UsageError("--sound needs a voice: add --voice espeak")
        return None
    if ability(robot, Speaks) is None:
        raise UsageError("--voice needs the simulated robot: leave out --robot")
    if file and (file.suffix != ".wav" or not file.parent.is_dir()):
        raise UsageError(f"can't write a sound to {file}: name a .wav file in an existing folder")
    feature, where = owner("voices", voice), table("voices")[voice]
    found: RobotVoice = called(feature, where, language, file, track)
    need_made(feature, where, found, RobotVoice, "a voice")
    if distribution_of(feature):
        found = AddedVoice(found, feature, voice)
    if found.mute:
        print(
            "No sound player is installed: the speech is silent; `--sound FILE.wav` writes it to a file.",
            file=sys.stderr,
        )
    return found
