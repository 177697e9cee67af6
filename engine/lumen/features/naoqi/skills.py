"""The abilities of a real NAO or Pepper: how each command begins, and how it ends early."""

import logging
from collections.abc import Callable, Mapping, Sequence
from math import inf
from typing import assert_never

from lumen.errors import BadCommandError, RobotFailedError, RobotRefusedError
from lumen.features.naoqi.call_sequence import CallSequence, CallSteps
from lumen.features.naoqi.hardware import hardware_of
from lumen.features.naoqi.lights import fades
from lumen.features.naoqi.microphones import Microphones
from lumen.features.naoqi.motion_player import MotionPlayer
from lumen.features.naoqi.session import NaoqiSession
from lumen.features.naoqi.walking_area import WalkingArea
from lumen.features.naoqi.walks import NaoqiWalks
from lumen.language.commands import Leds, Look, Move, PlaySound, Posture, Rest, Say, Stop, Volume, Wake, Walk
from lumen.language.robots import Body
from lumen.ports import Aim, Live, NativeCommand, Perform, Record
from lumen.robot.command_table import parts_of
from lumen.robot.cues import EventSink
from lumen.robot.joint_ways import LOOK_SPEED

LANGUAGE_NAMES = {
    "en": "English", "id": "Indonesian", "fr": "French", "de": "German", "es": "Spanish", "it": "Italian",
    "ja": "Japanese", "zh": "Chinese", "ko": "Korean", "nl": "Dutch", "pt": "Portuguese", "ar": "Arabic",
    "ru": "Russian", "tr": "Turkish", "pl": "Polish", "sv": "Swedish", "da": "Danish", "fi": "Finnish",
    "cs": "Czech", "el": "Greek", "nb": "Norwegian",
}  # fmt: skip
"""NAOqi's language names by ISO 639-1 code."""


def words(text: str) -> str:
    r"""Return the text without the signs of voice commands such as `\vol=100\` or `^run(…)`.

    Spoken texts contain visitors' names. `\…\` would permanently change the volume, speed or language, and `^…(…)`
    would make ALAnimatedSpeech start behaviours.
    """
    printable = "".join(sign if sign.isprintable() and sign not in "\\^" else " " for sign in text)
    return " ".join(printable.split())


def language_of(code: str, spoken: Sequence[str]) -> str:
    """Return NAOqi's name for a language code; empty if `spoken`, the robot's languages, lacks that name."""
    name = LANGUAGE_NAMES.get(code.partition("-")[0].lower(), code)
    return name if name in spoken else ""


LOOK_TOLERANCE = 0.03
"""The distance below which a head joint has reached its goal [rad]."""
LOOK_GRACE = 1.0
"""The time allowed for a look beyond the movement's duration [s]."""
WAKE_SPEED = 0.5
SOUND_FOLDER = "/home/nao/lumen"
"""The folder of the exhibition's sounds on the robot, because NAOqi plays only files on the robot's disk."""

_log = logging.getLogger(__name__)


class NaoqiSkills:
    """Begins activities; `fallen` is True from a fall until the robot has reached a posture again.

    If `body_language` is True, NAOqi makes the gestures of speech.
    """

    def __init__(
        self, session: NaoqiSession, body: Body, area: WalkingArea, notice: EventSink, clock: Callable[[], float]
    ) -> None:
        post = self._post = session.post
        self._body, self._clock = body, clock
        self._microphones = Microphones(session, notice, clock)
        self._walks = NaoqiWalks(post, area)
        self._player = MotionPlayer(post, body, notice, clock)
        self._unspoken: set[str] = set()
        self.fallen = False
        self.body_language = False

    def begin(self, command: NativeCommand, now: float) -> CallSequence:
        """Return the activity of a command that begins at `now` [s].

        Raises RobotError if the robot can't perform it.
        """
        match command:
            case Say():
                return CallSequence(self._say(command), lambda: [self._post("ALTextToSpeech", "stopAll")])
            case Record():
                return self._microphones.begin(command)
            case Rest():
                return CallSequence(self._rest(), patience=inf)
            case Posture(name, speed):
                return self._posture(name, speed)
            case Wake():
                return CallSequence(self._wake(), lambda: [self._post("ALRobotPosture", "stopMove")])
            case Leds(colours, seconds):
                return self._leds(colours, seconds)
            case Volume(level):
                return CallSequence(self._volume(level))
            case PlaySound(file):
                return CallSequence(self._sound(file), lambda: [self._post("ALAudioPlayer", "stopAll")])
            case Stop() | Aim() | Live():
                raise BadCommandError(f"{type(command).__name__} has no duration")
        if self.fallen:
            raise RobotRefusedError("the robot has fallen: `wake` it first")
        match command:
            case Perform(motion):
                return self._player.begin(motion, parts_of(command, self._body))
            case Look(yaw, pitch):
                return self._look(self._body.roles.head_joints(yaw, pitch))
            case Walk() | Move():
                return self._walks.begin(command)
            case _:
                assert_never(command)

    def _say(self, said: Say) -> CallSteps:
        text, language = said.text, said.language
        spoken = yield self._post("ALTextToSpeech", "getAvailableLanguages")
        name = language_of(language, list(map(str, spoken or ()))) if language else ""
        if language and not name and language not in self._unspoken:
            self._unspoken.add(language)
            _log.warning(
                "the robot has no voice for `%s` (it has %s): it reads the text in the language that it is set to",
                language,
                ", ".join(map(str, spoken or ())) or "none",
            )
        if not (spelt := words(text)):
            return
        if not self.body_language or said.gestures == "none":
            yield self._post("ALTextToSpeech", "say", spelt, *([name] if name else []))
            return
        if name:
            yield self._post("ALTextToSpeech", "setLanguage", name)
        yield self._post("ALAnimatedSpeech", "say", spelt, {"bodyLanguageMode": "contextual"})

    def _volume(self, level: float) -> CallSteps:
        yield self._post("ALTextToSpeech", "setVolume", level)

    def _sound(self, file: str) -> CallSteps:
        yield self._post("ALAudioPlayer", "playFile", f"{SOUND_FOLDER}/{file}")

    def _leds(self, colours: Mapping[str, str], seconds: float) -> CallSequence:
        """Return the activity of a fade; a cancelled fade changes the lights immediately: NAOqi can't stop fades."""
        return CallSequence(
            self._fade(colours, seconds),
            lambda: [self._post("ALLeds", "fadeRGB", *fade) for fade in fades(colours, self._body)],
        )

    def _fade(self, colours: Mapping[str, str], seconds: float) -> CallSteps:
        begin = self._clock()
        calls = [self._post("ALLeds", "fadeRGB", *fade) for fade in fades(colours, self._body, seconds)]
        while self._clock() < begin + seconds and not any(call.failed for call in calls):
            yield None
        for call in calls:  # noqa: UP028  `yield from` would send the answers into a list
            yield call

    def _posture(self, name: str, speed: float) -> CallSequence:
        return CallSequence(self._go(name, speed), lambda: [self._post("ALRobotPosture", "stopMove")])

    def _go(self, name: str, speed: float) -> CallSteps:
        if self.fallen and not hardware_of(self._body).gets_up:
            raise RobotRefusedError(
                "the robot has fallen and cannot get up by itself: set it on its feet, then `wake` it"
            )
        if not (yield self._post("ALMotion", "robotIsWakeUp")):
            if not self.fallen:
                raise RobotRefusedError("the motors are off: `wake` first")
            yield self._post("ALMotion", "setStiffnesses", "Body", 1.0)  # the fall manager has switched the motors off
        if not (yield self._post("ALRobotPosture", "goToPosture", name, float(speed))):
            raise RobotFailedError(f"the robot could not reach the posture {name}")
        self.fallen = False

    def _wake(self) -> CallSteps:
        yield self._post("ALMotion", "wakeUp")
        if not (yield self._post("ALRobotPosture", "goToPosture", "Stand", WAKE_SPEED)):
            raise RobotFailedError("the robot could not stand up")
        self.fallen = False

    def _rest(self) -> CallSteps:
        yield self._post("ALMotion", "rest")

    def _look(self, target: Mapping[str, float]) -> CallSequence:
        names = list(target)
        return CallSequence(self._turn(target), lambda: [self._post("ALMotion", "killTasksUsingResources", names)])

    def _turn(self, target: Mapping[str, float]) -> CallSteps:
        names, goal = list(target), list(target.values())
        if not (yield self._post("ALMotion", "robotIsWakeUp")):
            raise RobotRefusedError("the motors are off: `wake` first")
        here = yield self._post("ALMotion", "getAngles", names, True)
        way = max(abs(a - b) for a, b in zip(here, goal, strict=True))
        slowest = min(self._body.joints[name].speed for name in names)
        yield self._post("ALMotion", "setAngles", names, goal, min(1.0, LOOK_SPEED / slowest))
        until = self._clock() + way / LOOK_SPEED + LOOK_GRACE
        while self._clock() < until:
            here = yield self._post("ALMotion", "getAngles", names, True)
            if all(abs(a - b) < LOOK_TOLERANCE for a, b in zip(here, goal, strict=True)):
                return
            yield None
        raise RobotFailedError("the head did not reach its target: something holds it, or its motors are off")
