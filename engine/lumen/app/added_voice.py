"""A voice of an installed package: a fault in it costs the sound, and not the run."""

import logging
from collections.abc import Callable
from math import isfinite
from typing import TYPE_CHECKING, TypeVar

from lumen.feature import Feature
from lumen.language.diagnostics import Diagnostic
from lumen.language.gestures import WordTime
from lumen.loading.broken_features import faults_reported, shown
from lumen.robots.command_table import speech_duration

if TYPE_CHECKING:
    from lumen.app.voice import RobotVoice

T = TypeVar("T")
_log = logging.getLogger(__name__)


class AddedVoice:
    """Speaks with `voice`, a row of a feature with that `name`. After its first fault, which is logged, it is silent.

    A silent text takes as long as one of a robot without a voice.
    """

    def __init__(self, voice: "RobotVoice", feature: Feature, name: str) -> None:
        self._voice, self._feature, self._name = voice, feature, name
        self.words: tuple[WordTime, ...] = ()
        self._silent = False

    @property
    def mute(self) -> bool:
        """Whether nobody hears anything."""
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
