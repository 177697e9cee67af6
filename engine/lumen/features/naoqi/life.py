"""Lifelike movements of a real NAO or Pepper.

Lumen moves the joints with `ALMotion.setAngles` and lights the eyes; NAOqi breathes and blinks if the style selects
that.
"""

from collections.abc import Callable, Collection, Mapping
from dataclasses import replace

from lumen.errors import RobotError
from lumen.features.naoqi.hardware import hardware_of
from lumen.features.naoqi.lights import fades
from lumen.features.naoqi.session import NaoqiCall, NaoqiSession
from lumen.language.body_parts import ARMS, HEAD, LEGS, VOICE, WHOLE_BODY
from lumen.language.commands import Leds, Posture, Rest, Say, Wake
from lumen.language.gestures import NO_GESTURES
from lumen.language.life import NAOQI_BLINKING, NAOQI_BREATHING, NAOQI_SPEECH, OWN_LEGS, STILL_STYLE
from lumen.language.lights import LIGHT_GROUPS, lights_of
from lumen.language.robots import Body
from lumen.motion.bounds import nearest_angles
from lumen.motion.life import vigour
from lumen.ports import Live, Perform, RobotCommand
from lumen.robot.command_table import speech_duration
from lumen.robot.life_layer import LifeLayer

OURS_AFTER = 0.5
"""The time after a light command for which life leaves the eyes unchanged [s].

The command's calls may still be in progress.
"""

UNLIT = "white"
"""The colour of eyes that no command has lit."""


class NaoqiEyes:
    """Sends the eyes' colour when it changes. `post` calls NAOqi."""

    def __init__(self, post: Callable[..., NaoqiCall], body: Body) -> None:
        self._post, self._body = post, body
        self._lit, self._lit_until = False, 0.0
        self._worn = UNLIT
        self._sent = NaoqiCall()

    def begins(self, command: RobotCommand, now: float) -> None:
        """Record the eye colours of a new command; the colour `white` returns control of the eyes to this class."""
        match command:
            case Leds(colours, seconds):
                self._light(colours, now + seconds)
            case Perform(motion):
                for cue in sorted((cue for cue in motion.cues if cue.kind == "leds"), key=lambda cue: cue.time):
                    self._light(cue.value, now + cue.time)

    def wear(self, colour: str, now: float) -> None:
        """Show this colour in the eyes unless a command has lit them; `off` is a blink, an empty text white.

        A colour is skipped while NAOqi has not answered the last call.
        """
        colour = colour or UNLIT
        if self._lit or now < self._lit_until or colour == self._worn or not self._sent.done:
            return
        self._worn = colour
        for fade in fades({"eyes": colour}, self._body):
            self._sent = self._post("ALLeds", "fadeRGB", *fade)

    def _light(self, colours: object, until: float) -> None:
        for light, colour in lights_of(colours if isinstance(colours, Mapping) else {}):
            if light in LIGHT_GROUPS["eyes"]:
                self._lit, self._lit_until, self._worn = colour != UNLIT, until + OURS_AFTER, UNLIT


SEND_PERIOD = 0.1
"""The time between two updates of the joints' goals [s]; NAOqi interpolates between goals."""

SPEED = 0.3
"""The share of their maximum speed at which joints move to these goals, from 0 to 1."""

REST_AFTER = 0.5
"""The time after a command before lifelike movements begin again [s], because NAOqi finishes late."""


class NaoqiLife:
    """Adds the life layer's offsets to the joints' angles after the last command.

    Legs stay still unless the style has `naoqi: [legs]`, because swaying has not been tested on a real robot. The
    movements begin after a `Wake` or `Posture` command and end with a `Rest` command. `owner` returns the id of the
    command that moves a body part; empty for none.
    """

    def __init__(self, session: NaoqiSession, owner: Callable[[str], str], body: Body) -> None:
        self.layer = LifeLayer(body)
        self._session, self._post, self._owner, self._body = session, session.post, owner, body
        self._eyes = NaoqiEyes(session.post, body)
        self._joints = [j for part in (HEAD, ARMS, LEGS) for j in body.parts.get(part, ()) if j not in body.shared]
        self._legs = frozenset(body.parts.get(LEGS, ()))
        self._breathes = self._blinks = False
        self._stands: dict[str, float] = {}
        self._asked: NaoqiCall | None = None
        self._sent, self._last, self._busy_at = NaoqiCall(), 0.0, 0.0
        self._awake = False

    @property
    def body_language(self) -> bool:
        """Whether NAOqi makes the gestures of speech."""
        return self._has(NAOQI_SPEECH, "ALAnimatedSpeech")

    def live(self, command: Live) -> None:
        """Begin a style of life; if it selects NAOqi's gestures of speech, Lumen makes no gestures."""
        self.layer.live(replace(command, gestures=NO_GESTURES) if NAOQI_SPEECH in command.style.naoqi else command)

    def begins(self, command: RobotCommand, now: float) -> None:
        """Adapt the movements to a new command that makes the robot stand, rest or speak, or lights its eyes."""
        self._eyes.begins(command, now)
        match command:
            case Rest():
                self._awake = False
                self.layer.still()
            case Wake() | Posture():
                self._awake = True
            case Say(text):
                self.layer.say(command, speech_duration(text), now)

    def lose(self) -> None:
        """Forget NAOqi's state, because a restarted NAOqi neither breathes nor blinks."""
        self._breathes = self._blinks = False
        self._sent = NaoqiCall()

    def led(self, angles: Mapping[str, float], now: float) -> None:
        """Record that joints are aimed at these angles [rad], to which `alive` and `tick` add offsets."""
        self.layer.led(angles, now)
        self._stands |= {joint: angle for joint, angle in angles.items() if joint in self._stands}

    def alive(self, angles: Mapping[str, float]) -> dict[str, float]:
        """Return the angles [rad] to send for joints aimed at `angles`, including the joints' offsets."""
        return {joint: angle + self.layer.offsets.get(joint, 0.0) for joint, angle in angles.items()}

    def tick(self, now: float, heat: Mapping[str, float], percentage: float) -> None:
        """Send the eyes' colour and the joints' goals at `now` [s] if the robot is awake and no command moves it.

        Skip the goals while NAOqi is busy. `heat` has the motors' temperatures by joint [degrees Celsius], `percentage`
        is the battery's charge [%].
        """
        free = frozenset(part for part in WHOLE_BODY if not self._owner(part))
        if not self._owner(VOICE):
            self.layer.hush(now)
        lives = self._awake and {HEAD, ARMS, LEGS} <= free
        self._switch(lives=lives and now >= self._busy_at + REST_AFTER)
        if not lives:
            self._busy_at, self._asked = now, None
            self._stands.clear()
            self.layer.still()
        else:
            self._look(now)
        if lives and now >= self._busy_at + REST_AFTER and self._sent.done and now >= self._last + SEND_PERIOD:
            self._live(now, free, heat, percentage)

    def _live(self, now: float, free: Collection[str], heat: Mapping[str, float], percentage: float) -> None:
        still = self.layer.style == STILL_STYLE
        if (still and not self._stands) or not self._known():
            return

        def level(part: str) -> float:
            warmest = max((heat.get(joint, 0.0) for joint in self._body.parts[part]), default=0.0)
            return vigour(warmest, percentage)

        offsets = self.layer.advance(now, min(now - self._last, 2 * SEND_PERIOD), self._ours(free), level)
        self._last = now
        if still and not offsets:
            self._stands.clear()
        led = self._body.parts.get(HEAD, ()) if self.layer.leading(now) else ()
        barred = {*led, *(() if OWN_LEGS in self.layer.style.naoqi else self._legs)}
        own = {joint: stands for joint, stands in self._stands.items() if joint in offsets and joint not in barred}
        if own:
            near = nearest_angles({joint: a + offsets[joint] for joint, a in own.items()}, self._body, self._stands)
            goals = {joint: near[joint] for joint in own}
            self._sent = self._post("ALMotion", "setAngles", list(goals), list(goals.values()), SPEED)

    def _look(self, now: float) -> None:
        """Send the eyes' present colour, but no blinks while NAOqi makes its own."""
        colour = self.layer.eyes(now)
        if self._session.has("ALLeds") and not (colour == "off" and self._blinks):
            self._eyes.wear(colour, now)

    def _switch(self, *, lives: bool) -> None:
        """Switch NAOqi's breathing and blinking as the style selects; breathing also requires `lives`."""
        breathes = lives and NAOQI_BREATHING in self.layer.style.naoqi
        if breathes != self._breathes:
            self._breathes = breathes
            for chain in hardware_of(self._body).breathing:
                self._post("ALMotion", "setBreathEnabled", chain, breathes)
        blinks = self._has(NAOQI_BLINKING, "ALAutonomousBlinking")
        if blinks != self._blinks:
            self._blinks = blinks
            self._post("ALAutonomousBlinking", "setEnabled", blinks)

    def _has(self, part: str, service: str) -> bool:
        return part in self.layer.style.naoqi and self._session.has(service)

    def _known(self) -> bool:
        """Return whether the joints' angles without offsets are known; if not, request them."""
        if self._stands:
            return True
        if self._asked is None:
            self._asked = self._post("ALMotion", "getAngles", self._joints, False)
        if self._asked.done:
            try:
                self._stands = dict(zip(self._joints, map(float, self._asked.result()), strict=True))
            except (RobotError, TypeError, ValueError):
                self._asked = None
        return bool(self._stands)

    def _ours(self, free: Collection[str]) -> Collection[str]:
        """Return the `free` body parts that Lumen moves: only the head while NAOqi breathes."""
        return {HEAD} & set(free) if self._breathes else free
