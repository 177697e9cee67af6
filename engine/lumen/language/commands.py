"""Commands of a behaviour: values that a step returns and the runtime performs.

Lengths are in [m], angles in [rad], times in [s]. The robot answers each `Start` with one of the events
`done.command.ID`, `error.command.ID` or `cancelled.command.ID`.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

from lumen.feature import VerbRow
from lumen.language.sections import Sections

Channel = Literal["all", "walk", "play", "say"]


SaysGestures = Literal["none", ""]
"""`none`: a text is spoken without the gestures that would accompany it."""


@dataclass(frozen=True, slots=True)
class Say:
    """Speak a text; `language` is one of the project's, or empty if the project has none."""

    text: str
    language: str = ""
    gestures: SaysGestures = ""


@dataclass(frozen=True, slots=True)
class Ask:
    """Find an answer to a visitor's question.

    The parts of the answer arrive as events `answer.command.ID`; `error.command.ID` means that there is no answer.
    """

    question: str
    """The question; names of people must be removed from it."""
    language: str = ""
    """The language of the answer."""
    within: float = 0.0
    """The time limit [s]."""
    place: str = ""
    """The name of the robot's place; empty if it is unknown or has no name."""


@dataclass(frozen=True, slots=True)
class Play:
    """Play the motion of that name."""

    motion: str


@dataclass(frozen=True, slots=True)
class Posture:
    """Go to a posture of the robot; `speed` is a fraction of the maximum speed, above 0 and at most 1."""

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

    In the YAML, `to` may contain `{{ expression }}`, which a step fills in.
    """

    to: str


@dataclass(frozen=True, slots=True)
class Move:
    """Keep walking: `vx` forward, `vy` to the left [m/s], `vtheta` to the left [rad/s].

    It ends with a stop, or when another command needs the legs; another `Move` continues it with new speeds.
    """

    vx: float = 0.0
    vy: float = 0.0
    vtheta: float = 0.0


@dataclass(frozen=True, slots=True)
class Look:
    """Turn the head to these angles: `yaw` to the left, `pitch` down [rad], as in NAOqi."""

    yaw: float = 0.0
    pitch: float = 0.0


@dataclass(frozen=True, slots=True)
class Leds:
    """Set groups of lights to colours, by name or `#rrggbb`, with a linear transition of `duration` [s]."""

    colours: Mapping[str, str]
    duration: float = 0.0


@dataclass(frozen=True, slots=True)
class Volume:
    """Set the volume of speech, from the next text on: 0 is silent, 1 the loudest."""

    level: float


@dataclass(frozen=True, slots=True)
class PlaySound:
    """Play a sound file of the project, named by its path from the project's folder.

    `length` is its duration [s], which the performer reads from the file; it is never in the YAML.
    """

    file: str
    length: float = field(default=0.0, metadata={"yaml": False})


@dataclass(frozen=True, slots=True)
class Track:
    """Start or end a controller's control of its joints."""

    controller: str
    on: bool = True


@dataclass(frozen=True, slots=True)
class Stop:
    """Stop all that is running, or one kind of it, without losing balance."""

    what: Channel = "all"


@dataclass(frozen=True, slots=True)
class Rest:
    """Stop, go safely to Crouch, and turn the motors off.

    `by` is the person who demanded the rest, empty if no person did; it is never in the YAML.
    """

    by: str = field(default="", metadata={"yaml": False})


@dataclass(frozen=True, slots=True)
class Wake:
    """Turn the motors on, and stand."""


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
    """Raise an event for another robot of the house."""

    robot: str
    event: str
    data: Any = None


@dataclass(frozen=True, slots=True)
class Log:
    """Write a line into the exhibition's log."""

    text: str


@dataclass(frozen=True, slots=True)
class Do:
    """Perform the verb `skill` of a feature or of a file of the project.

    In the YAML a text in `arguments` can contain `{{ expression }}`, which a step fills in.
    """

    skill: str
    """The name of the verb."""
    arguments: Mapping[str, Any] = field(default_factory=dict)
    """JSON data that fit the schema of the verb's row."""
    sections: Sections = field(default_factory=dict, repr=False, compare=False, metadata={"yaml": False})
    """The settings in the project's sections, added for the performer; never in YAML or a message."""
    row: VerbRow | None = field(default=None, repr=False, compare=False, metadata={"yaml": False})
    """The row of a verb that a file of the project declares; None for the verb of an installed package."""


MotorCommand = Posture | Walk | Move | Look | Leds | Volume | PlaySound | Stop | Rest | Wake
"""The verbs of the YAML that the robot itself performs. A new one is added here and in `verbs.py`."""

VerbCommand = MotorCommand | Play | Track | Language | GoTo | Do
"""Verbs of the YAML that are commands themselves. Only the texts of `GoTo` and `Do` can contain expressions.

`Do` is the open member: it carries the verbs that features add (`lumen.language.added_verbs`).
"""

BodyCommand = VerbCommand | Say | Ask
"""The commands of the robot, and of the parts of the runtime that move it or answer for it."""


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
"""Every command that a step can return."""
