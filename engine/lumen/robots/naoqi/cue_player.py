"""What goes on beside the joints of a motion: lights, sounds, and the words and sounds that others perform."""

import logging

from lumen.errors import RobotError
from lumen.language.motions import MotionDefinition
from lumen.robots.cues import CueNotifier, EventSink
from lumen.robots.naoqi.lights import fades
from lumen.robots.naoqi.session import NaoqiCall
from lumen.robots.naoqi.walks import PostCall

SOUND_FOLDER = "/home/nao/lumen"
"""Where the exhibition's sounds are on the robot: NAOqi plays files of its own disk."""

_log = logging.getLogger(__name__)


class CuePlayer:
    """The cues of a motion, each when its time has come; a sound that can't be played is logged once in `silent`."""

    def __init__(self, post: PostCall, motion: MotionDefinition, notice: EventSink, silent: set[str]) -> None:
        self._post, self._silent = post, silent
        self._cues = sorted((cue for cue in motion.cues if cue.kind in ("leds", "sound")), key=lambda cue: -cue.time)
        self._prompter = CueNotifier(motion, notice)
        self._begin = 0.0
        self._sounds: list[tuple[str, NaoqiCall]] = []

    def begin(self, now: float) -> None:
        self._begin = now

    def __call__(self, now: float) -> None:
        self._prompter.advance(now - self._begin, now)
        while self._cues and self._cues[-1].time <= now - self._begin:
            cue = self._cues.pop()
            if cue.kind == "sound":
                file = f"{SOUND_FOLDER}/{cue.value}"
                self._sounds.append((file, self._post("ALAudioPlayer", "playFile", file)))
            for fade in fades(cue.value):
                self._post("ALLeds", "fadeRGB", *fade)
        for file, call in [(f, c) for f, c in self._sounds if c.done]:
            self._sounds.remove((file, call))
            self._hear(file, call)

    def end(self) -> list[NaoqiCall]:
        """Silence what still sounds."""
        return [self._post("ALAudioPlayer", "stopAll")] if self._sounds else []

    def _hear(self, file: str, call: NaoqiCall) -> None:
        try:
            call.result()
        except RobotError as error:
            if file not in self._silent:
                self._silent.add(file)
                _log.warning("the robot can't play %s (%s): it goes on without", file, error)
