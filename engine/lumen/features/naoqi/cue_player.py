"""What goes on beside the joints of a motion: lights, and the words and sounds that the exhibition performs."""

from lumen.features.naoqi.lights import fades
from lumen.features.naoqi.walks import PostCall
from lumen.language.motions import MotionDefinition
from lumen.language.robots import Body
from lumen.robot.cues import CueNotifier, EventSink


class CuePlayer:
    """The cues of a motion, each when its time has come."""

    def __init__(self, post: PostCall, motion: MotionDefinition, body: Body, notice: EventSink) -> None:
        self._post, self._body = post, body
        self._cues = sorted((cue for cue in motion.cues if cue.kind == "leds"), key=lambda cue: -cue.time)
        self._prompter = CueNotifier(motion, notice)
        self._begin = 0.0

    def begin(self, now: float) -> None:
        self._begin = now

    def __call__(self, now: float) -> None:
        self._prompter.advance(now - self._begin, now)
        while self._cues and self._cues[-1].time <= now - self._begin:
            for fade in fades(self._cues.pop().value, self._body):
                self._post("ALLeds", "fadeRGB", *fade)
