"""The idle movements of a robot while nothing else moves it, from `motions/life/NAME.yaml`: frozen values."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from lumen.language.diagnostics import NodePath

STILL = "still"
"""The style in which a robot never moves by itself; it needs no file."""


NAOQI_SPEECH, NAOQI_BREATHING, NAOQI_BLINKING, OWN_LEGS = "speech", "breathing", "blinking", "legs"
NAOQI_PARTS = (NAOQI_SPEECH, NAOQI_BREATHING, NAOQI_BLINKING, OWN_LEGS)
"""The values under `naoqi` of a style, for a real NAO: the movements that NAOqi performs instead of Lumen.

OWN_LEGS is the exception: it lets Lumen's sways move the legs too.
"""


@dataclass(frozen=True, slots=True)
class Sway:
    """Joints that swing together around their current angles."""

    name: str
    """The sway's name in the file."""
    period: float
    """The period [s]."""
    joints: Mapping[str, float]
    """The amplitudes by joint [rad; hands 0..1]."""
    wanders: bool = False
    """True if the movement varies instead of repeating itself exactly."""
    where: NodePath = field(default=(), compare=False)


@dataclass(frozen=True, slots=True)
class Glances:
    """Glances of the head: to one side, and back."""

    every: float
    """The length of the periods, each of which has one glance [s]."""
    yaw: float
    """The maximum turn to either side [rad]."""
    pitch: float
    """The maximum turn up or down [rad]."""
    hold: float = 1.0
    """The time before the head returns [s]."""


@dataclass(frozen=True, slots=True)
class Nods:
    """Nods of the head, one in each period of `every` [s], `pitch` [rad] deep."""

    every: float
    pitch: float


@dataclass(frozen=True, slots=True)
class Blinks:
    """Blinks, one in each period of `every` [s], in which the eyes are dark for `length` [s]."""

    every: float
    length: float = 0.15


@dataclass(frozen=True, slots=True)
class Asides:
    """A look aside before an answer: the head turns by `yaw` and up by `pitch` [rad], stays for `hold` [s], returns."""

    yaw: float
    pitch: float
    hold: float = 0.6


@dataclass(frozen=True, slots=True)
class Settles:
    """The offsets from the posture to which joints settle [rad; hands 0..1], within `takes` [s]."""

    joints: Mapping[str, float]
    takes: float = 1.5
    where: NodePath = ("settles",)


@dataclass(frozen=True, slots=True)
class EyeColours:
    """The colours of the eyes while nothing else lights them; empty to leave them unchanged.

    `thinking` is the colour while the robot looks aside before an answer.
    """

    silent: str = ""
    speaking: str = ""
    thinking: str = ""


@dataclass(frozen=True, slots=True)
class LifeStyle:
    """A style of idle movement."""

    name: str
    """The style's name."""
    sways: tuple[Sway, ...] = ()
    glances: Glances | None = None
    nods: Nods | None = None
    blinks: Blinks | None = None
    attention: float = 0.0
    """The time that the robot looks at the place of a touch or a voice [s]; 0 if it never does."""
    eyes: EyeColours = EyeColours()
    asides: Asides | None = None
    settles: Settles | None = None
    naoqi: tuple[str, ...] = ()
    """The movements that NAOqi makes on a real NAO: values of `NAOQI_PARTS`."""

    @property
    def amplitudes(self) -> Mapping[str, float]:
        """The maximum deflection of each joint, sways and settled angle together [rad; hands 0..1]."""
        settles = self.settles.joints if self.settles else {}
        found = {joint: abs(angle) for joint, angle in settles.items()}
        for sway in self.sways:
            for joint, angle in sway.joints.items():
                found[joint] = found.get(joint, 0.0) + abs(angle)
        return found


STILL_STYLE = LifeStyle(STILL)
