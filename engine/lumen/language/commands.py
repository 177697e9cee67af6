"""What a behaviour asks of the world: values that a step returns and the edge performs.

Lengths in [m], angles in [rad], times in [s]; what a `Start` holds is answered by the robot with the events
`done.command.ID`, `error.command.ID` or `cancelled.command.ID`.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

from lumen.feature import VerbRow
from lumen.language.sections import Sections

Channel = Literal["all", "walk", "play", "say"]


SaysGestures = Literal["none", ""]
"""Whether a text is said without the gestures that would accompany it."""


@dataclass(frozen=True, slots=True)
class Say:
    """Speak a text; `language` is one of the project's, or empty where it has none."""

    text: str
    language: str = ""
    gestures: SaysGestures = ""


@dataclass(frozen=True, slots=True)
class Ask:
    """Find out what answers a visitor's `question`, `within` so long [s]; names are not in it any more.

    What is found comes as events `answer.command.ID`; `error.command.ID` says that nobody knows. `language` is what is
    to be spoken, `place` where the robot is.
    """

    question: str
    language: str = ""
    within: float = 0.0
    place: str = ""


@dataclass(frozen=True, slots=True)
class Play:
    """Play the motion of that name."""

    motion: str


@dataclass(frozen=True, slots=True)
class Posture:
    """Go to a posture of the robot; `speed` is a fraction of the greatest, in (0, 1]."""

    name: str
    speed: float = 0.5


@dataclass(frozen=True, slots=True)
class Walk:
    """Walk to a pose relative to the robot: `x` forward, `y` left [m], `theta` to the left [rad]."""

    x: float = 0.0
    y: float = 0.0
    theta: float = 0.0


@dataclass(frozen=True, slots=True)
class GoTo:
    """Walk to the place of that name, one of `places` in lumen.yaml.

    Where it stands in the YAML, `to` may hold `{{ expression }}`, which a step fills in.
    """

    to: str


@dataclass(frozen=True, slots=True)
class Move:
    """Walk on: `vx` forward, `vy` to the left [m/s], `vtheta` to the left [rad/s].

    It ends where something stops it, or where another command wants the legs; another `Move` goes on from it.
    """

    vx: float = 0.0
    vy: float = 0.0
    vtheta: float = 0.0


@dataclass(frozen=True, slots=True)
class Look:
    """Turn the head: `yaw` to the left, `pitch` down [rad], as NAO counts them."""

    yaw: float = 0.0
    pitch: float = 0.0


@dataclass(frozen=True, slots=True)
class Leds:
    """Give groups of lights their colours, by name or `#rrggbb`, on an even way of `duration` [s]."""

    colours: Mapping[str, str]
    duration: float = 0.0


@dataclass(frozen=True, slots=True)
class Volume:
    """Speak with this volume from the next text on: 0 is silent, 1 the loudest; what is being said is said on."""

    level: float


@dataclass(frozen=True, slots=True)
class PlaySound:
    """Play a sound file of the project, named from its folder.

    `length` is how long it takes [s], which whoever performs it reads from the file; no YAML says it.
    """

    file: str
    length: float = field(default=0.0, metadata={"yaml": False})


@dataclass(frozen=True, slots=True)
class Track:
    """Let a controller move its joints, or take them from it."""

    controller: str
    on: bool = True


@dataclass(frozen=True, slots=True)
class Stop:
    """End what is running, keeping balance."""

    what: Channel = "all"


@dataclass(frozen=True, slots=True)
class Rest:
    """Stop, go safely to Crouch, motors off.

    `by` is the person who wants that, empty where it is nobody's wish; no YAML says it.
    """

    by: str = field(default="", metadata={"yaml": False})


@dataclass(frozen=True, slots=True)
class Wake:
    """Motors on, stand."""


@dataclass(frozen=True, slots=True)
class Language:
    """Speak this language from now on."""

    language: str


@dataclass(frozen=True, slots=True)
class Publish:
    """Send a body (JSON data) on a route."""

    route: str
    body: Any = None


@dataclass(frozen=True, slots=True)
class Tell:
    """Let another robot of the house hear an event."""

    robot: str
    event: str
    data: Any = None


@dataclass(frozen=True, slots=True)
class Log:
    """Write a line into the exhibition's log."""

    text: str


@dataclass(frozen=True, slots=True)
class Do:
    """Perform the verb `skill` of a feature; `arguments` are JSON data that fit the schema of its row.

    In the YAML a text in them can contain `{{ expression }}`, which a step fills in. `sections` are those of the
    project for the performer, added when the command goes to the robot; no YAML or message contains them. `row` is that
    of a verb which a file of the project declares; None for the verb of an installed package.
    """

    skill: str
    arguments: Mapping[str, Any] = field(default_factory=dict)
    sections: Sections = field(default_factory=dict, repr=False, compare=False, metadata={"yaml": False})
    row: VerbRow | None = field(default=None, repr=False, compare=False, metadata={"yaml": False})


MotorCommand = Posture | Walk | Move | Look | Leds | Volume | PlaySound | Stop | Rest | Wake
"""What stands in the YAML as the robot performs it. A new one goes here, and into `verbs.py`."""

VerbCommand = MotorCommand | Play | Track | Language | GoTo | Do
"""Verbs of the YAML that are their own commands: `GoTo` and `Do` alone can contain expressions, in texts.

`Do` is the open member: it carries the verbs that features add (`lumen.language.added_verbs`).
"""

BodyCommand = VerbCommand | Say | Ask
"""What a robot performs, or the parts of the runtime that move it, or answer it."""


@dataclass(frozen=True, slots=True)
class Start:
    """Begin a command; its end is reported under `id`."""

    id: str
    command: BodyCommand


@dataclass(frozen=True, slots=True)
class Cancel:
    """End the command of that id early, as soon as the body is balanced."""

    id: str


Command = Start | Cancel | Publish | Tell | Log
"""Everything a step can ask for."""
