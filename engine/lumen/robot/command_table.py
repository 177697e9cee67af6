"""The properties of each command that every robot needs, however it performs the command: a row for each.

A row has the parts of the body that the command owns, its rank among waiting commands, its duration on the recording
robot, and its form on the bus. Robots that move perform it in their `skills.py`.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from math import hypot, inf
from typing import Any, Generic, TypeVar

from lumen.errors import BadCommandError
from lumen.language.added_verbs import added_row
from lumen.language.body_parts import EARS, HEAD, LEGS, VOICE, WHOLE_BODY, parts_of_lights, parts_of_motion
from lumen.language.commands import (
    Channel,
    Do,
    Leds,
    Look,
    Move,
    PlaySound,
    Posture,
    Rest,
    Say,
    Stop,
    Volume,
    Wake,
    Walk,
)
from lumen.language.gestures import NO_GESTURES, merged
from lumen.language.robots import Body
from lumen.language.skills import lack_of
from lumen.ports import Aim, Live, Perform, Record, RobotCommand
from lumen.project.added_verbs import time_taken
from lumen.robot.command_checks import (
    aimed,
    check_aim,
    check_arguments,
    check_lights,
    check_look,
    check_motion,
    check_posture,
    check_sound,
    check_volume,
    read_added,
    read_lights,
    read_posture,
    read_recording,
    read_rest,
    read_sound,
    read_stop,
    read_style,
    read_volume,
)
from lumen.robot.command_parameters import CommandParameters
from lumen.robot.motion_codec import decode_motion, encode_motion

C = TypeVar("C")

SPEECH_PAUSE, SPEECH_PER_CHARACTER = 0.4, 0.06
"""The base duration of a text on a robot without a voice, and the additional duration of each character [s]."""
WALKING_SPEED, TURNING_SPEED = 0.1, 0.25
"""The speed of the recording robot's walk [m/s] and turn [rad/s]: the simulated robot turns by 90 degrees in 7 s."""
USUAL_DURATION, LOOK_DURATION = 2.0, 1.0
"""The durations of most commands, and of a turn of the head, on the recording robot [s]."""


@dataclass(frozen=True, slots=True)
class CommandRow(Generic[C]):
    """The properties of one command."""

    command: type[C]
    verb: str
    """The verb of the command in the YAML, or in motions and modules."""
    rank: int
    """The rank of the command: of those that wait, those of the lowest rank begin first."""
    kind: str
    """The `type` of the command's body on the bus, spelt as in 2015 if the command existed then."""
    method: str
    """The `method` of the command's body."""
    encode: Callable[[C], Mapping[str, Any]]
    """Returns the `parameter` of the command's body."""
    decode: Callable[[CommandParameters], C]
    """Returns the command with the parameters of a body. Raises BadCommandError if they are invalid."""
    parts: Callable[[C, Body], frozenset[str]]
    """Returns the parts of the body that the command owns from its beginning to its end."""
    duration: Callable[[C], float] = lambda _: USUAL_DURATION
    """Returns how long the recording robot takes [s]."""
    channel: Channel | None = None
    """The channel of the command `stop` that ends this command, besides `all`; None if there is none."""
    check: Callable[[C, Body], None] = lambda _command, _body: None
    """Raises BadCommandError for a command that no robot of that body can perform."""
    moves: bool = True
    """Whether the command is refused while a person keeps the robot still."""


def owns(*parts: str) -> Callable[[object, Body], frozenset[str]]:
    """Return a function that returns the same parts for any command and body."""
    owned = frozenset(parts)
    return lambda _command, _body: owned


def speech_duration(text: str) -> float:
    """Return the duration of a text on a robot without a voice [s]."""
    return SPEECH_PAUSE + SPEECH_PER_CHARACTER * len(text)


_STOP = CommandRow(Stop, "stop", 0, "motion", "stop", lambda c: {"what": c.what}, read_stop, owns(), moves=False)
_REST = CommandRow(
    Rest, "rest", 0, "motion", "rest", lambda c: {"by": c.by} if c.by else {}, read_rest, owns(*WHOLE_BODY), moves=False
)
_WAKE = CommandRow(Wake, "wake", 1, "motion", "wakeUp", lambda c: {}, lambda p: Wake(), owns(*WHOLE_BODY))
_POSTURE = CommandRow(
    Posture,
    "posture",
    1,
    "posture",
    "goToPosture",
    lambda c: {"postureName": c.name, "speed": c.speed},
    read_posture,
    owns(*WHOLE_BODY),
    check=check_posture,
)
_WALK = CommandRow(
    Walk,
    "walk",
    1,
    "motion",
    "moveTo",
    lambda c: {"x": c.x, "y": c.y, "tetha": c.theta},
    lambda p: Walk(p.number("x", 0.0), p.number("y", 0.0), p.turn()),
    owns(LEGS),
    lambda c: hypot(c.x, c.y) / WALKING_SPEED + abs(c.theta) / TURNING_SPEED,
    channel="walk",
)
_MOVE = CommandRow(
    Move,
    "walk",
    2,
    "motion",
    "move",
    lambda c: {"x": c.vx, "y": c.vy, "tetha": c.vtheta},
    lambda p: Move(p.number("x", 0.0), p.number("y", 0.0), p.turn()),
    owns(LEGS),
    lambda c: inf if any((c.vx, c.vy, c.vtheta)) else 1.0,
    channel="walk",
)
_SAY = CommandRow(
    Say,
    "say",
    2,
    "texttospeech",
    "say",
    lambda c: {"text": c.text, "language": c.language, **({"gestures": "none"} if c.gestures else {})},
    lambda p: Say(p.text("text"), p.language("language"), "none" if p.values.get("gestures") == "none" else ""),
    owns(VOICE),
    lambda c: speech_duration(c.text),
    channel="say",
    moves=False,
)
_PERFORM = CommandRow(
    Perform,
    "play",
    2,
    "motion",
    "perform",
    lambda c: {"motion": encode_motion(c.motion)},
    lambda p: Perform(decode_motion(p.values.get("motion"), p.project.body)),
    lambda c, body: parts_of_motion(c.motion, body),
    lambda c: c.motion.duration,
    channel="play",
    check=check_motion,
)
_RECORD = CommandRow(
    Record,
    "record",
    2,
    "audiodevice",
    "record",
    lambda c: {"recordingName": c.name, "duration": c.duration},
    read_recording,
    owns(EARS),
    lambda c: c.duration,
    moves=False,
)
_LOOK = CommandRow(
    Look,
    "look",
    3,
    "motion",
    "look",
    lambda c: {"yaw": c.yaw, "pitch": c.pitch},
    lambda p: Look(p.number("yaw", 0.0), p.number("pitch", 0.0)),
    owns(HEAD),
    lambda c: LOOK_DURATION,
    check=check_look,
)
_LEDS = CommandRow(
    Leds,
    "leds",
    3,
    "leds",
    "leds",
    lambda c: {"colours": dict(c.colours), "duration": c.duration},
    read_lights,
    lambda c, _body: parts_of_lights(c.colours),
    lambda c: c.duration,
    check=check_lights,
    moves=False,
)
_VOLUME = CommandRow(
    Volume,
    "volume",
    1,
    "texttospeech",
    "setVolume",
    lambda c: {"volume": c.level},
    read_volume,
    owns(),
    lambda c: 0.0,
    check=check_volume,
    moves=False,
)
_SOUND = CommandRow(
    PlaySound,
    "sound",
    2,
    "audioplayer",
    "playFile",
    lambda c: {"file": c.file, "duration": c.length},
    read_sound,
    owns(),
    lambda c: c.length,
    channel="play",
    check=check_sound,
    moves=False,
)
"""A sound waits for no part of the body: a bell rings while the robot speaks."""
_AIM = CommandRow(
    Aim,
    "aim",
    3,
    "motion",
    "setAngles",
    lambda c: {"jointNames": list(c.angles), "angles": list(c.angles.values()), "speed": c.speed},
    lambda p: aimed(p, p.joints()),
    owns(),
    check=check_aim,
)
"""An aim is not answered, and moves only joints that no command owns."""

_LIVE = CommandRow(
    Live,
    "life",
    3,
    "motion",
    "live",
    lambda c: {"style": c.style.name, "gestures": bool(c.gestures)},
    lambda p: Live(read_style(p), merged(p.project.gestures) if p.values.get("gestures") else NO_GESTURES),
    owns(),
    moves=False,
)
"""This command sets a style and moves nothing by itself, so it is allowed while a person keeps the robot still."""

_DO = CommandRow(
    Do,
    "do",
    2,
    "skill",
    "do",
    lambda c: {"skill": c.skill, "arguments": dict(c.arguments)},
    read_added,
    owns(),
    check=lambda c, _body: check_arguments(c),
)
"""The verbs of features cross the bus in one form; the rest of the row is that of each verb (`row_of`)."""

COMMANDS: tuple[CommandRow[Any], ...] = (
    _WAKE, _REST, _STOP, _POSTURE, _WALK, _MOVE, _SAY, _PERFORM, _RECORD, _LOOK, _LEDS, _VOLUME, _SOUND, _AIM,
    _LIVE, _DO,
)  # fmt: skip

_BY_COMMAND: Mapping[type, CommandRow[Any]] = {row.command: row for row in COMMANDS}


def row_of(command: RobotCommand) -> CommandRow[Any]:
    """Return the row of a command."""
    return _row_of_added(command) if isinstance(command, Do) else _BY_COMMAND[type(command)]


def _row_of_added(command: Do) -> CommandRow[Do]:
    verb = added_row(command)
    if verb is None:
        return replace(_DO, verb=command.skill)
    return replace(_DO, verb=command.skill, parts=owns(*verb.parts), duration=time_taken, moves=verb.moves)


def check_command(command: RobotCommand, body: Body) -> None:
    """Raise BadCommandError for a command that no robot of that body can perform."""
    if lack := lack_of(command, body):
        raise BadCommandError(f"`{row_of(command).verb}`: {lack.message}")
    row_of(command).check(command, body)


def parts_of(command: RobotCommand, body: Body) -> frozenset[str]:
    """Return the parts of the body that a command owns from its beginning to its end."""
    return row_of(command).parts(command, body)
