"""The verbs of the YAML that are commands: a row for each, with its fields and how it reads in transcripts and diffs.

All generic code uses these rows: `project/actions.py` reads commands with them, `project/formats/behavior_data.py`
writes them, the language server completes names in them, and the transcript and the diff of bundles describe them. The
properties that robots need are in `robot/command_table.py`. `tests/seams/test_verbs.py` checks both tables and the
schemas.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from enum import Enum
from functools import lru_cache
from typing import Any, Generic, TypeVar

from lumen.language.actions import (
    Action,
    AskQuestion,
    Assign,
    CancelSend,
    ComputedAction,
    If,
    LogText,
    Parallel,
    PublishBody,
    Raise,
    SayText,
    Send,
    Wait,
)
from lumen.language.commands import (
    Do,
    GoTo,
    Language,
    Leds,
    Look,
    Move,
    Play,
    PlaySound,
    Posture,
    Rest,
    Stop,
    Track,
    VerbCommand,
    Volume,
    Wake,
    Walk,
)

C = TypeVar("C")


class Quantity(Enum):
    """The kind of a value in the YAML, which decides how it is converted for the command."""

    PLAIN = "used as written: a text, a number without a unit, true or false"
    LENGTH = "in the file's unit of length, [m] in the command; per second, [m/s]"
    ANGLE = "in the file's unit of angles, [rad] in the command; per second, [rad/s]"
    DURATION = "a number and its unit, such as `500ms`; [s] in the command"
    TEMPLATE = "a text that can contain `{{ expression }}`, replaced when the command begins"


@dataclass(frozen=True, slots=True)
class VerbField:
    """A field of a command, under the name that it has in the YAML and in the dataclass."""

    name: str
    quantity: Quantity = Quantity.PLAIN
    """The kind of the value, which decides the value's unit."""
    names: str = ""
    """The kind of item that the value names: `motion`, `posture`, `controller`, `language` or `place`; else ""."""
    others: bool = False
    """True if the value is the map of all keys that no other field has."""


@dataclass(frozen=True, slots=True)
class Verb(Generic[C]):
    """A verb that is a command.

    Its data are a map from fields to values, or the first field's value alone; without fields they are `true`.
    """

    name: str
    """The name in the YAML, which two commands may share."""
    command: type[C]
    """The command's class."""
    fields: tuple[VerbField, ...]
    transcript: Callable[[C], str]
    """A function that describes the robot's action, for a transcript: `plays dance`."""
    change: Callable[[C], str]
    """A function that describes the action for a diff of bundles, in “`greet` now … on entering”."""
    pair: bool = False
    """True if the data are a map from the first field's value to the second's: `track: {head: false}`."""
    mapped: bool = False
    """True if the data are a map even though there is only one field: `walk: {to: organ}`."""
    instant: bool = False
    """True if the command ends at once, because the runtime performs it and not the robot."""

    def arguments(self, data: Any) -> Iterator[tuple[VerbField, tuple[str, ...], Any]]:
        """Yield each field that the verb's YAML data contain, with its path below the verb and its value."""
        if not self.fields:
            return
        if not isinstance(data, Mapping):
            yield self.fields[0], (), data
        elif self.pair:
            for key, value in data.items():
                yield self.fields[0], (key,), key
                yield self.fields[1], (key,), value
        else:
            names = {field.name for field in self.fields if not field.others}
            for field in self.fields:
                if field.others:
                    yield field, (), {key: value for key, value in data.items() if key not in names}
                elif field.name in data:
                    yield field, (field.name,), data[field.name]

    def data(self, command: C, written: Callable[[Quantity, Any], Any]) -> Any:
        """Return the verb's YAML data for this command; `written` converts the value of a field to the YAML's form."""
        values = {field.name: written(field.quantity, getattr(command, field.name)) for field in self.fields}
        if len(values) < 2 and not self.mapped:
            given = next(iter(values.values()), True)
            return True if given == {} else given
        if self.pair:
            name, value = values.values()
            return {name: value}
        others = [values.pop(field.name) for field in self.fields if field.others]
        return {key: value for given in (*others, values) for key, value in given.items()}


_PLAY = Verb(
    "play",
    Play,
    (VerbField("motion", names="motion"),),
    lambda c: f"plays {c.motion}",
    lambda c: f"plays `{c.motion}`",
)
_POSTURE = Verb(
    "posture",
    Posture,
    (VerbField("name", names="posture"), VerbField("speed")),
    lambda c: f"goes into the posture {c.name}",
    lambda c: f"goes to `{c.name}` at speed {c.speed:g}",
)
_MOVE = Verb(
    "walk",
    Move,
    (VerbField("vx", Quantity.LENGTH), VerbField("vy", Quantity.LENGTH), VerbField("vtheta", Quantity.ANGLE)),
    lambda c: f"keeps walking at {c.vx:g} m/s, {c.vy:g} m/s, {c.vtheta:.2f} rad/s",
    lambda c: f"keeps walking at x {c.vx:g} m/s, y {c.vy:g} m/s, theta {c.vtheta:.3g} rad/s",
)
_GO_TO = Verb(
    "walk",
    GoTo,
    (VerbField("to", Quantity.TEMPLATE, names="place"),),
    lambda c: f"walks to {c.to}",
    lambda c: f"walks to `{c.to}`",
    mapped=True,
)
_WALK = Verb(
    "walk",
    Walk,
    (VerbField("x", Quantity.LENGTH), VerbField("y", Quantity.LENGTH), VerbField("theta", Quantity.ANGLE)),
    lambda c: f"walks {c.x:g} m, {c.y:g} m, {c.theta:.2f} rad",
    lambda c: f"walks to x {c.x:g} m, y {c.y:g} m, theta {c.theta:.3g} rad",
)
_LOOK = Verb(
    "look",
    Look,
    (VerbField("yaw", Quantity.ANGLE), VerbField("pitch", Quantity.ANGLE)),
    lambda c: "turns its head",
    lambda c: f"turns its head to yaw {c.yaw:.3g} rad, pitch {c.pitch:.3g} rad",
)
_LEDS = Verb(
    "leds",
    Leds,
    (VerbField("colours", others=True), VerbField("duration", Quantity.DURATION)),
    lambda c: f"lights {', '.join(f'{group} {colour}' for group, colour in c.colours.items())}",
    lambda c: f"lights {', '.join(f'{group} `{colour}`' for group, colour in c.colours.items())} in {c.duration:g} s",
)
_VOLUME = Verb(
    "volume",
    Volume,
    (VerbField("level"),),
    lambda c: f"sets the volume to {c.level:g}",
    lambda c: f"sets the volume to {c.level:g}",
)
_SOUND = Verb(
    "sound",
    PlaySound,
    (VerbField("file"),),
    lambda c: f"sounds {c.file}",
    lambda c: f"plays the sound `{c.file}`",
)
_TRACK = Verb(
    "track",
    Track,
    (VerbField("controller", names="controller"), VerbField("on")),
    lambda c: f"{'follows the face with' if c.on else 'lets go of'} {c.controller}",
    lambda c: f"{'lets' if c.on else 'no longer lets'} `{c.controller}` track",
    pair=True,
    instant=True,
)
_STOP = Verb("stop", Stop, (VerbField("what"),), lambda c: f"stops {c.what}", lambda c: f"stops `{c.what}`")
_REST = Verb("rest", Rest, (), lambda c: "rests", lambda c: "rests")
_WAKE = Verb("wake", Wake, (), lambda c: "wakes", lambda c: "wakes")
_LANGUAGE = Verb(
    "language",
    Language,
    (VerbField("language", names="language"),),
    lambda c: f"speaks {c.language} from now on",
    lambda c: f"switches to `{c.language}`",
    instant=True,
)

VERBS: tuple[Verb[Any], ...] = (
    _PLAY, _POSTURE, _GO_TO, _MOVE, _WALK, _LOOK, _LEDS, _VOLUME, _SOUND, _TRACK, _STOP, _REST, _WAKE, _LANGUAGE,
)  # fmt: skip
"""The rows of all verbs. Of rows that share a name, the fields in the data select one, else the last row is used."""

COMPUTED: Mapping[type[ComputedAction], str] = {
    SayText: "say", PublishBody: "publish", Assign: "assign", Raise: "raise", Send: "send", CancelSend: "cancel",
    Wait: "wait", LogText: "log", If: "if", Parallel: "parallel",
    AskQuestion: "ask",
}  # fmt: skip
"""The names of the other verbs, which the statechart itself evaluates; a `match` over their classes handles each."""

_BY_COMMAND: Mapping[type, Verb[Any]] = {verb.command: verb for verb in VERBS}


def verb_of(command: VerbCommand) -> Verb[Any]:
    """Return the row of a command; for an added verb, a new row with its name."""
    return _added(command.skill) if isinstance(command, Do) else _BY_COMMAND[type(command)]


@lru_cache
def _added(name: str) -> Verb[Do]:
    return Verb(
        name,
        Do,
        (VerbField("arguments", others=True),),
        lambda c: f"does {name}{_listed(c.arguments)}",
        lambda c: f"does `{name}`{_listed(c.arguments)}",
    )


def _listed(arguments: Mapping[str, Any]) -> str:
    """Return the arguments in words, ` with times 3, eye left`; empty if there are none."""
    listed = ", ".join(f"{name} {value}" for name, value in arguments.items())
    return f" with {listed}" if listed else ""


def is_built_in(name: str) -> bool:
    """Return True for the name of a verb that comes with Lumen, and for `then` and `else`, which no verb may have."""
    return name in ("then", "else", *COMPUTED.values()) or any(verb.name == name for verb in VERBS)


def names_in(action: Action, kind: str) -> Iterator[str]:
    """Yield the names of one kind, such as `motion` or `posture`, in the fields of an action."""
    verb = _BY_COMMAND.get(type(action))
    yield from (getattr(action, field.name) for field in verb.fields if field.names == kind) if verb else ()


def verb_named(name: str, data: Any) -> Verb[Any] | None:
    """Return the row for a verb of the YAML and its data; None if the verb is not a command."""
    rows = [verb for verb in VERBS if verb.name == name]
    said = data.keys() if isinstance(data, Mapping) else ()
    meant = (verb for verb in rows if any(field.name in said for field in verb.fields))
    return next(meant, rows[-1] if rows else None)
