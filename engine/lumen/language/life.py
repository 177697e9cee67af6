"""What a robot does while nothing else moves it, as `motions/life/NAME.yaml` says it: frozen values."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from lumen.language.diagnostics import NodePath

STILL = "still"
"""The style in which a robot never moves by itself; it needs no file."""


NAOQI_SPEECH, NAOQI_BREATHING, NAOQI_BLINKING, OWN_LEGS = "speech", "breathing", "blinking", "legs"
NAOQI_PARTS = (NAOQI_SPEECH, NAOQI_BREATHING, NAOQI_BLINKING, OWN_LEGS)
"""What a real NAO does by NAOqi in place of ours, where a style says so; and that our sways move its legs, too."""


@dataclass(frozen=True, slots=True)
class Sway:
    """Joints that go to and fro together around where they stand, by `joints` [rad; hands 0..1] at most.

    Once in `period` [s]; where it `wanders`, never twice in the same way.
    """

    name: str
    period: float
    joints: Mapping[str, float]
    wanders: bool = False
    where: NodePath = field(default=(), compare=False)


@dataclass(frozen=True, slots=True)
class Glances:
    """Once in `every` [s] the head turns by at most `yaw` and `pitch` [rad] for `hold` [s], then back."""

    every: float
    yaw: float
    pitch: float
    hold: float = 1.0


@dataclass(frozen=True, slots=True)
class Nods:
    """Once in `every` [s] the head nods, `pitch` [rad] deep."""

    every: float
    pitch: float


@dataclass(frozen=True, slots=True)
class Blinks:
    """Once in `every` [s] the eyes go dark for `length` [s]."""

    every: float
    length: float = 0.15


@dataclass(frozen=True, slots=True)
class Asides:
    """As it begins to answer, the head turns by `yaw` [rad] to one side and up by `pitch` for `hold` [s], then back."""

    yaw: float
    pitch: float
    hold: float = 0.6


@dataclass(frozen=True, slots=True)
class Settles:
    """The angles `joints` [rad; hands 0..1] to which joints settle beside their posture, within `takes` [s]."""

    joints: Mapping[str, float]
    takes: float = 1.5
    where: NodePath = ("settles",)


@dataclass(frozen=True, slots=True)
class EyeColours:
    """The colours of the eyes while nothing else lights them, empty where they stay as they are.

    `thinking` is for while it looks aside before an answer.
    """

    silent: str = ""
    speaking: str = ""
    thinking: str = ""


@dataclass(frozen=True, slots=True)
class LifeStyle:
    """A way to be alive. `attention` [s] is how long it looks where it was touched or spoken to; 0 for not at all.

    `naoqi` are those of `NAOQI_PARTS` that a real NAO does, too.
    """

    name: str
    sways: tuple[Sway, ...] = ()
    glances: Glances | None = None
    nods: Nods | None = None
    blinks: Blinks | None = None
    attention: float = 0.0
    eyes: EyeColours = EyeColours()
    asides: Asides | None = None
    settles: Settles | None = None
    naoqi: tuple[str, ...] = ()

    @property
    def amplitudes(self) -> Mapping[str, float]:
        """The maximum sway of each joint, including where it has settled [rad; hands 0..1]."""
        settles = self.settles.joints if self.settles else {}
        found = {joint: abs(angle) for joint, angle in settles.items()}
        for sway in self.sways:
            for joint, angle in sway.joints.items():
                found[joint] = found.get(joint, 0.0) + abs(angle)
        return found


STILL_STYLE = LifeStyle(STILL)
