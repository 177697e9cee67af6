"""The eyes of a real NAO that lives: it blinks, and they say what it does, unless somebody has lit them."""

from collections.abc import Callable, Mapping

from lumen.features.naoqi.lights import fades
from lumen.features.naoqi.session import NaoqiCall
from lumen.language.commands import Leds
from lumen.language.lights import LIGHT_GROUPS, lights_of
from lumen.language.robots import Body
from lumen.ports import Perform, RobotCommand

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
