"""Life on a real NAO: head and arms by `ALMotion.setAngles`, its eyes, and NAOqi's own where a style says so."""

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
"""How long after eyes were lit they are ours at the soonest [s]: what lights them is on its way."""

UNLIT = "white"
"""The colour of eyes that nobody has lit."""


class NaoqiEyes:
    """Sends the colour that the eyes are to have, where it changes. `post` calls NAOqi."""

    def __init__(self, post: Callable[..., NaoqiCall], body: Body) -> None:
        self._post, self._body = post, body
        self._lit, self._lit_until = False, 0.0
        self._worn = UNLIT
        self._sent = NaoqiCall()

    def begins(self, command: RobotCommand, now: float) -> None:
        """A command begins that may light them; `white` leaves them to us again."""
        match command:
            case Leds(colours, seconds):
                self._light(colours, now + seconds)
            case Perform(motion):
                for cue in sorted((cue for cue in motion.cues if cue.kind == "leds"), key=lambda cue: cue.time):
                    self._light(cue.value, now + cue.time)

    def wear(self, colour: str, now: float) -> None:
        """Have them in this colour, `off` where it blinks; empty where they stay as they are."""
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
"""How often it is sent where the joints are wanted [s]; NAOqi goes on evenly in between."""

SPEED = 0.3
"""The part of their greatest speed with which joints go there."""

REST_AFTER = 0.5
"""How long nothing else has to move the robot until it lives again [s]: NAOqi is still on its way."""


class NaoqiLife:
    """Adds the layer's offsets to where head and arms stood when the last command had ended.

    Legs are left alone unless the style says `naoqi: [legs]`: nobody has shown on a real robot that swaying is safe. A
    robot lives from the first command that has it stand until it rests. `owner` names the command that moves a part.
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
        """Whether NAOqi gestures as it speaks, in place of us."""
        return self._has(NAOQI_SPEECH, "ALAnimatedSpeech")

    def live(self, command: Live) -> None:
        """Be alive like this from now on."""
        self.layer.live(replace(command, gestures=NO_GESTURES) if NAOQI_SPEECH in command.style.naoqi else command)

    def begins(self, command: RobotCommand, now: float) -> None:
        """A command begins that may let it stand, rest or speak, or light its eyes."""
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
        """The connection broke: NAOqi may have been restarted since, and neither breathes nor blinks."""
        self._breathes = self._blinks = False
        self._sent = NaoqiCall()

    def led(self, angles: Mapping[str, float], now: float) -> None:
        """Somebody aims joints there [rad]: they stand elsewhere from now on; see `alive`."""
        self.layer.led(angles, now)
        self._stands |= {joint: angle for joint, angle in angles.items() if joint in self._stands}

    def alive(self, angles: Mapping[str, float]) -> dict[str, float]:
        """Where to send joints that somebody aims there [rad]: so much beside it as they live."""
        return {joint: angle + self.layer.offsets.get(joint, 0.0) for joint, angle in angles.items()}

    def tick(self, now: float, heat: Mapping[str, float], percentage: float) -> None:
        """Send where the joints are wanted at `now` [s], unless NAOqi is still busy with the last."""
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
        """Have the eyes in the colour of the moment; it is NAOqi that blinks, where the style says so."""
        colour = self.layer.eyes(now)
        if self._session.has("ALLeds") and not (colour == "off" and self._blinks):
            self._eyes.wear(colour, now)

    def _switch(self, *, lives: bool) -> None:
        """Let NAOqi breathe and blink, or not: only where nothing else moves the robot."""
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
        """Whether it is known where the joints stand, without what was added; it is asked for where it is not."""
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
        """The parts that we move: the head alone where NAOqi breathes."""
        return {HEAD} & set(free) if self._breathes else free
