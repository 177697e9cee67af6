"""A story file as values: a scripted visitor, and what must happen."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from lumen.language.approvals import Autonomy
from lumen.language.diagnostics import NodePath
from lumen.language.hours import Schedule
from lumen.language.properties import Property


@dataclass(frozen=True, slots=True)
class Visitor:
    """A person in the hall, in the robot's frame at its start."""

    x: float = 1.5
    """The position ahead of the robot [m]."""
    y: float = 0.0
    """The position to the left of the robot [m]."""
    height: float = 1.65
    """The person's height [m]."""


@dataclass(frozen=True, slots=True)
class Arrive:
    """`visitor: {x, y, height}` or `visitor: arrives`: a visitor walks up."""

    visitor: Visitor


@dataclass(frozen=True, slots=True)
class Leave:
    """`visitor: leaves`: the visitor goes away."""


@dataclass(frozen=True, slots=True)
class Speak:
    """`says: TEXT`: the visitor speaks, in `language` if it is given."""

    text: str
    language: str = ""


@dataclass(frozen=True, slots=True)
class TouchSensor:
    """`touch: SENSOR` or `release: SENSOR`: a tactile sensor is pressed or released."""

    sensor: str
    pressed: bool = True


@dataclass(frozen=True, slots=True)
class Happen:
    """`event: NAME` or `event: {name, data}`: an event for the behaviour, without a message that causes it."""

    name: str
    data: Any = None


@dataclass(frozen=True, slots=True)
class Press:
    """`operator: {press: LABEL}`: an operator presses a button that is shown and works."""

    label: str


@dataclass(frozen=True, slots=True)
class Approve:
    """`operator: {approve: go}` or `stay`: an operator decides the request that has waited longest."""

    go: bool


@dataclass(frozen=True, slots=True)
class SetAutonomy:
    """`operator: {autonomy: alone}` or `ask`: transitions with `approve` no longer need a person, or need one."""

    level: Autonomy


@dataclass(frozen=True, slots=True)
class SendMessage:
    """`message: {route, body}`: a message as a module would send it."""

    route: str
    body: Any = None


@dataclass(frozen=True, slots=True)
class AnswerQuestion:
    """`answers: TEXT` or `answers: {raise, data}`: the reply of the module `answers` to the last question."""

    text: str = ""
    event: str = ""
    data: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class SetSkills:
    """`skills: {NAME: RESULT}`: the result of a skill from now on, or `fails` or `hangs`."""

    ends: Mapping[str, Mapping[str, Any] | str]


@dataclass(frozen=True, slots=True)
class StoryPause:
    """`wait: DURATION`: pause for `seconds` [s]."""

    seconds: float


@dataclass(frozen=True, slots=True)
class AwaitTime:
    """`at: "17:59"`: nothing happens until the wall clock shows that time."""

    schedule: Schedule


@dataclass(frozen=True, slots=True)
class Expect:
    """`expect:`: the story fails unless all of these conditions become true `within` the time limit.

    Only texts, motions, verbs and messages since the last fulfilled `expect` count. A field that is None sets no
    condition.
    """

    states: tuple[str, ...] = ()
    """States that must be active at the same time."""
    said: str | None = None
    """A part of a text that was spoken."""
    said_exactly: str | None = None
    """The whole of a text that was spoken."""
    played: str | None = None
    """A motion that has finished."""
    did: str | None = None
    """An added verb that has finished, with at least these `arguments`."""
    arguments: Mapping[str, Any] = field(default_factory=dict)
    published: str | None = None
    """A route on which a message was sent."""
    body: Any = None
    """Data that the message's body must contain; None for any body."""
    context: Mapping[str, Any] = field(default_factory=dict)
    """The values that context keys must have."""
    place: str | None = None
    """The robot's place, by its odometry."""
    within: float = 30.0
    """The time limit [s]."""


VisitorAction = (
    Arrive
    | Leave
    | Speak
    | TouchSensor
    | Happen
    | Press
    | Approve
    | SetAutonomy
    | SendMessage
    | AnswerQuestion
    | SetSkills
    | StoryPause
    | AwaitTime
    | Expect
)


@dataclass(frozen=True, slots=True)
class StoryStep:
    """One step of a story and its path in the document."""

    action: VisitorAction
    where: NodePath = field(default=(), compare=False)


@dataclass(frozen=True)
class Story:
    """A story, and the state of the world while it plays."""

    name: str
    title: str
    steps: tuple[StoryStep, ...]
    behavior: str = ""
    language: str = ""
    clock: Schedule | None = None
    """The time of day at the story's start; None if it does not matter."""
    context: Mapping[str, Any] = field(default_factory=dict)
    robot: Mapping[str, str | float] = field(default_factory=dict)
    """How the robot performs a verb, by verb: `fails`, `hangs` or a duration [s]."""
    results: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    """The results of added verbs, by verb."""
    never: tuple[str, ...] = ()
    """States that must never be entered."""
    properties: tuple[Property, ...] = ()
    """Properties that must hold in addition to those of the behaviour."""
