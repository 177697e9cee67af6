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
    """A person in the hall: their place in the robot's frame at its start, and their height [m]."""

    x: float = 1.5
    y: float = 0.0
    height: float = 1.65


@dataclass(frozen=True, slots=True)
class Arrive:
    """`visitor: {x, y, height}` or `visitor: arrives`: a visitor walks up."""

    visitor: Visitor


@dataclass(frozen=True, slots=True)
class Leave:
    """`visitor: leaves`."""


@dataclass(frozen=True, slots=True)
class Speak:
    """`says: TEXT`: the visitor speaks, in `language` where given."""

    text: str
    language: str = ""


@dataclass(frozen=True, slots=True)
class TouchSensor:
    """`touch: SENSOR` or `release: SENSOR`."""

    sensor: str
    pressed: bool = True


@dataclass(frozen=True, slots=True)
class Happen:
    """`event: NAME` or `event: {name, data}`: an event from nowhere."""

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
    """`operator: {autonomy: alone}` or `ask`: whether marked transitions go by themselves."""

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
    """`skills: {NAME: RESULT}`: a skill returns that from now on; if it is a text, it `fails` or `hangs`."""

    ends: Mapping[str, Mapping[str, Any] | str]


@dataclass(frozen=True, slots=True)
class StoryPause:
    """`wait: DURATION` [s]."""

    seconds: float


@dataclass(frozen=True, slots=True)
class AwaitTime:
    """`at: "17:59"`: nothing happens until the clock on the wall shows that."""

    schedule: Schedule


@dataclass(frozen=True, slots=True)
class Expect:
    """`expect:`: all of this holds, or comes to hold `within` [s], else the story fails.

    `states` are active together; `said` is part of a text said and `said_exactly` the whole of one, `played` a motion
    finished, `did` a verb of a feature finished that had at least these `arguments`, `published` a route on which a
    message was sent whose body has at least what `body` has (None: any), all since the last `expect` that held;
    `context` maps keys to values, `place` is the robot's, by its odometry.
    """

    states: tuple[str, ...] = ()
    said: str | None = None
    said_exactly: str | None = None
    played: str | None = None
    did: str | None = None
    arguments: Mapping[str, Any] = field(default_factory=dict)
    published: str | None = None
    body: Any = None
    context: Mapping[str, Any] = field(default_factory=dict)
    place: str | None = None
    within: float = 30.0


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
    """One step of a story and where it stands."""

    action: VisitorAction
    where: NodePath = field(default=(), compare=False)


@dataclass(frozen=True)
class Story:
    """A story, and how the world is while it plays.

    `robot` maps a verb to `fails`, `hangs` or its duration [s], `results` a verb of a feature to its result; `clock` is
    the time of day at its start; the states in `never` must never be entered, and its `properties` hold beside those of
    the behaviour.
    """

    name: str
    title: str
    steps: tuple[StoryStep, ...]
    behavior: str = ""
    language: str = ""
    clock: Schedule | None = None
    context: Mapping[str, Any] = field(default_factory=dict)
    robot: Mapping[str, str | float] = field(default_factory=dict)
    results: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    never: tuple[str, ...] = ()
    properties: tuple[Property, ...] = ()
