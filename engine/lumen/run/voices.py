"""`lumen run --voice NAME`: voices that say a robot's texts aloud, from rows of features."""

import logging
import sys
from collections.abc import Callable
from math import isfinite
from pathlib import Path
from typing import Protocol, TypeVar, runtime_checkable

from lumen.errors import UsageError
from lumen.feature import Feature, distribution_of, owner, table
from lumen.language.diagnostics import Diagnostic
from lumen.language.gestures import WordTime
from lumen.ports import Robot
from lumen.project.broken_features import called, faults_reported, need_made, shown
from lumen.robot.bounded_robot import ability
from lumen.robot.command_table import speech_duration
from lumen.run.audio_track import AudioTrack
from lumen.run.setup import Setup

T = TypeVar("T")
_log = logging.getLogger(__name__)


class RobotVoice(Protocol):
    """A voice of a simulated robot."""

    words: tuple[WordTime, ...]
    """When the words of the last text begin; empty if the voice does not measure that."""

    @property
    def mute(self) -> bool:
        """Whether the voice makes no sound that can be heard."""
        ...

    def begin(self, text: str, language: str, volume: float, now: float) -> float:
        """Say a text from `now` [s] on, with a `volume` from 0 to 1; return the duration [s]."""
        ...

    def end(self, now: float) -> None:
        """End the current text, which is over or was cancelled."""
        ...

    def close(self) -> None:
        """Release the resources of the voice."""
        ...


class AddedVoice:
    """A wrapper of `voice`, the row `name` of a package's feature; after a fault it logs the fault and is silent.

    A silent text takes as long as on a robot without a voice.
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
        """Return the result of a call of the voice; `otherwise` if the voice is silent or fails."""
        if self._silent:
            return otherwise
        faults: list[Diagnostic] = []
        with faults_reported(self._feature, f"its voice `{self._name}`", faults.append):
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

    def speak_with(self, voice: RobotVoice) -> None:
        """Say all texts with a voice."""
        ...


def voiced(
    chosen: Setup, voice: str, file: Path | None, language: str, track: AudioTrack | None = None
) -> Callable[[], None]:
    """Give the robot the voice, unless it is `none`; return a function that closes the voice.

    Raises UsageError if `file` can't be used, and UsageError or ModuleError if the voice is not available.
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
    """Return a voice; None for `none`. Raises UsageError or ModuleError if the voice is not available."""
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
