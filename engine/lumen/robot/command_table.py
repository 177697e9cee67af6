"""What every robot has to know of each command, but how it performs it: a row for each.

A row says which parts of the body the command owns, which of those that wait goes first, how long the recording robot
takes, and how it crosses the bus. Robots that move perform it in their `skills.py`.
"""

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import pairwise
from math import hypot, inf, isfinite
from typing import Any, Generic, TypeVar, get_args

from lumen.errors import BadCommandError
from lumen.expressions.json_schema import JsonSchema
from lumen.feature import VerbRow
from lumen.language.added_verbs import added_row, added_verbs, argument_schema, arguments_of
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
from lumen.language.diagnostics import did_you_mean
from lumen.language.gestures import NO_GESTURES, merged
from lumen.language.life import STILL, STILL_STYLE, LifeStyle
from lumen.language.lights import light_fault
from lumen.language.robots import Body
from lumen.language.skills import lack_of
from lumen.motion.bounds import nearest_angles
from lumen.ports import Aim, Live, Perform, Record, RobotCommand
from lumen.project.added_verbs import time_taken
from lumen.project.schema import faults
from lumen.project.sounds import MAX_SOUND_DURATION
from lumen.robot.command_parameters import CommandParameters, shown
from lumen.robot.motion_codec import decode_motion, encode_motion

C = TypeVar("C")

AIM_SPEED, POSTURE_SPEED = 0.3, 0.5
"""Fractions of the greatest speed where a command from the bus names none."""
RECORDING_DURATION, MAX_RECORDING_DURATION = 5.0, 20.0
"""How long a recording is, as in 2015, and at most [s]: a message holds 1 MiB."""
SPEECH_PAUSE, SPEECH_PER_CHARACTER = 0.4, 0.06
"""How long a text takes to say where nobody says it [s], and each of its characters."""
WALKING_SPEED, TURNING_SPEED = 0.1, 0.25
"""How fast a recorded walk goes [m/s] and turns [rad/s]: the simulated robot turns around by 90 degrees in 7 s."""
MAX_JUDGES = 256
"""The schemas of added verbs' arguments that are kept."""
MAX_FADE_DURATION = 60.0
"""How long lights may take to their colours [s]."""
USUAL_DURATION, LOOK_DURATION = 2.0, 1.0
"""How long the recording robot takes for a posture, and to turn its head [s]."""


@dataclass(frozen=True, slots=True)
class CommandRow(Generic[C]):
    """One command.

    `verb` is its name in the YAML, or what a motion or module calls it. Of commands that wait those of the lowest
    `rank` go first. `parts` are those of the body that it owns from its beginning to its end. `duration` is how long
    the recording robot takes [s]. On the bus it is `{type: kind, method, parameter}`, `encode` makes its parameters
    and `decode` reads them; spelt as in 2015 where 2015 had it. `stop: CHANNEL` ends it, as `stop: all` does.
    `check` raises BadCommandError for one that no robot of that body can perform. One that `moves` is for a robot that
    nobody has stopped.
    """

    command: type[C]
    verb: str
    rank: int
    kind: str
    method: str
    encode: Callable[[C], Mapping[str, Any]]
    decode: Callable[[CommandParameters], C]
    parts: Callable[[C, Body], frozenset[str]]
    duration: Callable[[C], float] = lambda _: USUAL_DURATION
    channel: Channel | None = None
    check: Callable[[C, Body], None] = lambda _command, _body: None
    moves: bool = True


def owns(*parts: str) -> Callable[[object, Body], frozenset[str]]:
    """The same parts of any body, for every command of a kind."""
    owned = frozenset(parts)
    return lambda _command, _body: owned


def speech_duration(text: str) -> float:
    """How long a text takes to say where nobody says it [s]."""
    return SPEECH_PAUSE + SPEECH_PER_CHARACTER * len(text)


def aimed(p: CommandParameters, angles: Mapping[str, float]) -> Aim:
    """An aim inside the joints' limits, as NAOqi would clip it."""
    return Aim(nearest_angles(angles, p.project.body), p.fraction("speed", AIM_SPEED))


def _posture(p: CommandParameters) -> Posture:
    name = p.text("posturename")
    postures = {known.lower(): known for known in p.project.body.postures}
    command = Posture(postures.get(name.lower(), shown(name)), p.fraction("speed", POSTURE_SPEED))
    _check_posture(command, p.project.body)
    return command


def _check_posture(command: Posture, body: Body) -> None:
    if not 0 < command.speed <= 1:
        raise BadCommandError(f"a speed must be above 0 and at most 1, not {command.speed}")
    if command.name not in body.postures:
        hint = did_you_mean(command.name, body.postures, "it knows")
        raise BadCommandError(f"no posture `{command.name}`: {hint}")


def _check_joints(angles: Mapping[str, float], body: Body) -> None:
    for name, angle in angles.items():
        if name not in body.joints:
            raise BadCommandError(f"`{name}` is not a joint of this robot: {did_you_mean(name, body.joints)}")
        if not isfinite(angle):
            raise BadCommandError(f"`{name}` cannot move to {angle}")


def _check_aim(command: Aim, body: Body) -> None:
    _check_joints(command.angles, body)
    if not command.speed > 0:
        raise BadCommandError(f"a speed must be above 0 and at most 1, not {command.speed}")


def _check_look(command: Look, body: Body) -> None:
    _check_joints(body.roles.head_joints(command.yaw, command.pitch), body)


def _check_motion(command: Perform, body: Body) -> None:
    motion = command.motion
    _check_joints(dict.fromkeys(motion.tracks, 0.0), body)
    keys = [key for track in motion.tracks.values() for key in track]
    numbers = (x for key in keys for x in (key.time, key.angle, *key.handle_in, *key.handle_out))
    if not (isfinite(motion.duration) and all(map(isfinite, numbers))):
        raise BadCommandError(f"`{motion.name}` has an angle or a time that is not a number")
    for joint, track in motion.tracks.items():
        if any(after <= before for before, after in pairwise([0.0, *(key.time for key in track)])):
            raise BadCommandError(f"the times of the keys of `{joint}` must be above 0 and increase")


def _check_lights(command: Leds, body: Body) -> None:
    if not 0 <= command.duration <= MAX_FADE_DURATION:
        raise BadCommandError(f"lights must take 0 to {MAX_FADE_DURATION:g} s, not {command.duration:g} s")
    if not command.colours:
        raise BadCommandError("`leds` needs at least one light")
    for group, colour in command.colours.items():
        if fault := light_fault(group, colour):
            raise BadCommandError(fault)


def _leds(p: CommandParameters) -> Leds:
    colours = p.values.get("colours")
    if not isinstance(colours, Mapping):
        raise BadCommandError("`leds` needs `colours`, an object with a colour for each light")
    command = Leds(
        {shown(str(light)): shown(str(colour)) for light, colour in colours.items()}, p.number("duration", 0.0)
    )
    _check_lights(command, p.project.body)
    return command


def _check_volume(command: Volume, body: Body) -> None:
    if not 0 <= command.level <= 1:
        raise BadCommandError(f"a volume must be between 0 and 1, not {command.level:g}")


def _volume(p: CommandParameters) -> Volume:
    command = Volume(p.number("volume"))
    _check_volume(command, p.project.body)
    return command


def _check_sound(command: PlaySound, body: Body) -> None:
    if not 0 <= command.length <= MAX_SOUND_DURATION:
        raise BadCommandError(f"a sound must last 0 to {MAX_SOUND_DURATION:g} s, not {command.length:g} s")
    if (
        not command.file
        or not command.file.isprintable()
        or command.file[:1] in "/\\"
        or ".." in command.file.replace("\\", "/").split("/")
    ):
        raise BadCommandError(f"`{shown(command.file)}` is not a file of the project")


def _sound(p: CommandParameters) -> PlaySound:
    command = PlaySound(p.text("file"), p.number("duration"))
    _check_sound(command, p.project.body)
    return command


def _stop(p: CommandParameters) -> Stop:
    """`what` is one of walk, play and say, or all."""
    what = p.text("what", "all").lower()
    known: dict[str, Channel] = {channel: channel for channel in get_args(Channel)}
    if what not in known:
        raise BadCommandError(f"`stop` can't end `{shown(what)}`: {did_you_mean(shown(what), known)}")
    return Stop(known[what])


def _rest(p: CommandParameters) -> Rest:
    """`by` is ours: the person who stops the robot."""
    return Rest(shown(p.text("by", "")))


def _style(p: CommandParameters) -> LifeStyle:
    """A style of the project's own."""
    name = shown(p.text("style"))
    if name == STILL:
        return STILL_STYLE
    if name not in p.project.life:
        raise BadCommandError(f"there is no style `{name}`: {did_you_mean(name, (STILL, *p.project.life))}")
    return p.project.life[name]


def _record(p: CommandParameters) -> Record:
    """`duration` [s] is ours."""
    duration = p.number("duration", RECORDING_DURATION)
    if not 0.1 <= duration <= MAX_RECORDING_DURATION:
        longest = f"{MAX_RECORDING_DURATION:g} s"
        raise BadCommandError(f"the `duration` of `record` must be between 0.1 and {longest}, not {duration:g}")
    return Record(shown(p.text("recordingname", "recording")), duration)


def added_verb(command: Do) -> VerbRow:
    """Return the row of an added verb. Raises BadCommandError if neither a feature nor the project has it."""
    if (row := added_row(command)) is None:
        verbs = added_verbs()
        hint = did_you_mean(command.skill, verbs, "the installed features have") if verbs else "install its package"
        raise BadCommandError(f"no feature here has a verb `{shown(command.skill)}`: {hint}")
    return row


@lru_cache(maxsize=MAX_JUDGES)
def _judge(schema: str) -> JsonSchema:
    """Return a JSON Schema that is made once: making it takes longer than all else that a command needs."""
    return JsonSchema(json.loads(schema))


def check_arguments(command: Do) -> None:
    """Raises BadCommandError if no feature has that verb, or if its arguments don't fit its row."""
    schema = argument_schema(added_verb(command))
    if _judge(json.dumps(schema)).fits(dict(command.arguments)):
        return
    for fault in faults(dict(command.arguments), schema):
        raise BadCommandError(f"`{command.skill}`: {fault.message}" + (f" ({fault.hint})" if fault.hint else ""))


def _do(p: CommandParameters) -> Do:
    arguments = p.values.get("arguments")
    if not isinstance(arguments, Mapping | None):
        raise BadCommandError("the `arguments` of `do` must be an object with names and values")
    skill = p.text("skill")
    command = Do(skill, {}, p.project.sections, p.project.verbs.get(skill))
    command = replace(command, arguments=arguments_of(added_verb(command), arguments or {}))
    check_arguments(command)
    return command


_STOP = CommandRow(Stop, "stop", 0, "motion", "stop", lambda c: {"what": c.what}, _stop, owns(), moves=False)
_REST = CommandRow(
    Rest, "rest", 0, "motion", "rest", lambda c: {"by": c.by} if c.by else {}, _rest, owns(*WHOLE_BODY), moves=False
)
_WAKE = CommandRow(Wake, "wake", 1, "motion", "wakeUp", lambda c: {}, lambda p: Wake(), owns(*WHOLE_BODY))
_POSTURE = CommandRow(
    Posture,
    "posture",
    1,
    "posture",
    "goToPosture",
    lambda c: {"postureName": c.name, "speed": c.speed},
    _posture,
    owns(*WHOLE_BODY),
    check=_check_posture,
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
    check=_check_motion,
)
_RECORD = CommandRow(
    Record,
    "record",
    2,
    "audiodevice",
    "record",
    lambda c: {"recordingName": c.name, "duration": c.duration},
    _record,
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
    check=_check_look,
)
_LEDS = CommandRow(
    Leds,
    "leds",
    3,
    "leds",
    "leds",
    lambda c: {"colours": dict(c.colours), "duration": c.duration},
    _leds,
    lambda c, _body: parts_of_lights(c.colours),
    lambda c: c.duration,
    check=_check_lights,
    moves=False,
)
_VOLUME = CommandRow(
    Volume,
    "volume",
    1,
    "texttospeech",
    "setVolume",
    lambda c: {"volume": c.level},
    _volume,
    owns(),
    lambda c: 0.0,
    check=_check_volume,
    moves=False,
)
_SOUND = CommandRow(
    PlaySound,
    "sound",
    2,
    "audioplayer",
    "playFile",
    lambda c: {"file": c.file, "duration": c.length},
    _sound,
    owns(),
    lambda c: c.length,
    channel="play",
    check=_check_sound,
    moves=False,
)
"""It waits for no part of the body: a bell rings while the robot speaks."""
_AIM = CommandRow(
    Aim,
    "aim",
    3,
    "motion",
    "setAngles",
    lambda c: {"jointNames": list(c.angles), "angles": list(c.angles.values()), "speed": c.speed},
    lambda p: aimed(p, p.joints()),
    owns(),
    check=_check_aim,
)
"""Nobody waits for an aim, and it moves what no command owns."""

_LIVE = CommandRow(
    Live,
    "life",
    3,
    "motion",
    "live",
    lambda c: {"style": c.style.name, "gestures": bool(c.gestures)},
    lambda p: Live(_style(p), merged(p.project.gestures) if p.values.get("gestures") else NO_GESTURES),
    owns(),
    moves=False,
)
"""A manner, and no movement: a robot whose motors are off has none."""

_DO = CommandRow(
    Do,
    "do",
    2,
    "skill",
    "do",
    lambda c: {"skill": c.skill, "arguments": dict(c.arguments)},
    _do,
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
    """The row of a command."""
    return _row_of_added(command) if isinstance(command, Do) else _BY_COMMAND[type(command)]


def _row_of_added(command: Do) -> CommandRow[Do]:
    verb = added_row(command)
    if verb is None:
        return replace(_DO, verb=command.skill)
    return replace(_DO, verb=command.skill, parts=owns(*verb.parts), duration=time_taken, moves=verb.moves)


def check_command(command: RobotCommand, body: Body) -> None:
    """Raises BadCommandError for a command that no robot of that body can perform."""
    if lack := lack_of(command, body):
        raise BadCommandError(f"`{row_of(command).verb}`: {lack.message}")
    row_of(command).check(command, body)


def parts_of(command: RobotCommand, body: Body) -> frozenset[str]:
    """The parts of the body that a command owns from its beginning to its end."""
    return row_of(command).parts(command, body)
