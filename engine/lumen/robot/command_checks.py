"""Reads the parameters of commands from the bus, and checks the values that a body can perform.

Each `read_…` returns a command from its parameters, and each `check_…` returns nothing. Both raise BadCommandError for
a command that no robot of that body can perform, `read_…` also for missing or wrong parameters.
"""

import json
from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache
from itertools import pairwise
from math import isfinite
from typing import get_args

from lumen.errors import BadCommandError
from lumen.expressions.json_schema import JsonSchema
from lumen.feature import VerbRow
from lumen.language.added_verbs import added_row, added_verbs, argument_schema, arguments_of
from lumen.language.commands import Channel, Do, Leds, Look, PlaySound, Posture, Rest, Stop, Volume
from lumen.language.diagnostics import did_you_mean
from lumen.language.life import STILL, STILL_STYLE, LifeStyle
from lumen.language.lights import light_fault
from lumen.language.robots import Body
from lumen.motion.bounds import nearest_angles
from lumen.ports import Aim, Perform, Record
from lumen.project.schema import faults
from lumen.project.sounds import MAX_SOUND_DURATION
from lumen.robot.command_parameters import CommandParameters, shown

AIM_SPEED, POSTURE_SPEED = 0.3, 0.5
"""Speeds of aims and postures as fractions of the maximum, if a command from the bus gives none."""

RECORDING_DURATION, MAX_RECORDING_DURATION = 5.0, 20.0
"""The default duration of a recording, as in 2015, and the longest [s], because a message holds at most 1 MiB."""

MAX_JUDGES = 256
"""The number of compiled schemas of added verbs' arguments that are cached."""

MAX_FADE_DURATION = 60.0
"""The longest time in which lights change to their colours [s]."""


def aimed(p: CommandParameters, angles: Mapping[str, float]) -> Aim:
    """Return an aim with its angles clipped to the joints' limits, as NAOqi does."""
    return Aim(nearest_angles(angles, p.project.body), p.fraction("speed", AIM_SPEED))


def read_posture(p: CommandParameters) -> Posture:
    name = p.text("posturename")
    postures = {known.lower(): known for known in p.project.body.postures}
    command = Posture(postures.get(name.lower(), shown(name)), p.fraction("speed", POSTURE_SPEED))
    check_posture(command, p.project.body)
    return command


def check_posture(command: Posture, body: Body) -> None:
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


def check_aim(command: Aim, body: Body) -> None:
    _check_joints(command.angles, body)
    if not command.speed > 0:
        raise BadCommandError(f"a speed must be above 0 and at most 1, not {command.speed}")


def check_look(command: Look, body: Body) -> None:
    _check_joints(body.roles.head_joints(command.yaw, command.pitch), body)


def check_motion(command: Perform, body: Body) -> None:
    motion = command.motion
    _check_joints(dict.fromkeys(motion.tracks, 0.0), body)
    keys = [key for track in motion.tracks.values() for key in track]
    numbers = (x for key in keys for x in (key.time, key.angle, *key.handle_in, *key.handle_out))
    if not (isfinite(motion.duration) and all(map(isfinite, numbers))):
        raise BadCommandError(f"`{motion.name}` has an angle or a time that is not a number")
    for joint, track in motion.tracks.items():
        if any(after <= before for before, after in pairwise([0.0, *(key.time for key in track)])):
            raise BadCommandError(f"the times of the keys of `{joint}` must be above 0 and increase")


def check_lights(command: Leds, body: Body) -> None:
    if not 0 <= command.duration <= MAX_FADE_DURATION:
        raise BadCommandError(f"lights must take 0 to {MAX_FADE_DURATION:g} s, not {command.duration:g} s")
    if not command.colours:
        raise BadCommandError("`leds` needs at least one light")
    for group, colour in command.colours.items():
        if fault := light_fault(group, colour):
            raise BadCommandError(fault)


def read_lights(p: CommandParameters) -> Leds:
    colours = p.values.get("colours")
    if not isinstance(colours, Mapping):
        raise BadCommandError("`leds` needs `colours`, an object with a colour for each light")
    command = Leds(
        {shown(str(light)): shown(str(colour)) for light, colour in colours.items()}, p.number("duration", 0.0)
    )
    check_lights(command, p.project.body)
    return command


def check_volume(command: Volume, body: Body) -> None:
    if not 0 <= command.level <= 1:
        raise BadCommandError(f"a volume must be between 0 and 1, not {command.level:g}")


def read_volume(p: CommandParameters) -> Volume:
    command = Volume(p.number("volume"))
    check_volume(command, p.project.body)
    return command


def check_sound(command: PlaySound, body: Body) -> None:
    if not 0 <= command.length <= MAX_SOUND_DURATION:
        raise BadCommandError(f"a sound must last 0 to {MAX_SOUND_DURATION:g} s, not {command.length:g} s")
    if (
        not command.file
        or not command.file.isprintable()
        or command.file[:1] in "/\\"
        or ".." in command.file.replace("\\", "/").split("/")
    ):
        raise BadCommandError(f"`{shown(command.file)}` is not a file of the project")


def read_sound(p: CommandParameters) -> PlaySound:
    command = PlaySound(p.text("file"), p.number("duration"))
    check_sound(command, p.project.body)
    return command


def read_stop(p: CommandParameters) -> Stop:
    """Return the command to stop `what`: walk, play, say or all. Raises BadCommandError for any other word."""
    what = p.text("what", "all").lower()
    known: dict[str, Channel] = {channel: channel for channel in get_args(Channel)}
    if what not in known:
        raise BadCommandError(f"`stop` can't end `{shown(what)}`: {did_you_mean(shown(what), known)}")
    return Stop(known[what])


def read_rest(p: CommandParameters) -> Rest:
    """Return the command to rest; `by`, which Lumen added, names the person who stops the robot."""
    return Rest(shown(p.text("by", "")))


def read_style(p: CommandParameters) -> LifeStyle:
    """Return the project's life style of that name, or the style that switches life off.

    Raises BadCommandError if there is no such style.
    """
    name = shown(p.text("style"))
    if name == STILL:
        return STILL_STYLE
    if name not in p.project.life:
        raise BadCommandError(f"there is no style `{name}`: {did_you_mean(name, (STILL, *p.project.life))}")
    return p.project.life[name]


def read_recording(p: CommandParameters) -> Record:
    """Return the command to record. Raises BadCommandError if its `duration` [s] is out of range.

    The `duration` is a parameter that Lumen added.
    """
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
    """Return a compiled JSON Schema, cached because compiling it takes longer than the rest of a command."""
    return JsonSchema(json.loads(schema))


def check_arguments(command: Do) -> None:
    """Raise BadCommandError if no feature or project has the verb, or if the arguments do not fit the verb's row."""
    schema = argument_schema(added_verb(command))
    if _judge(json.dumps(schema)).fits(dict(command.arguments)):
        return
    for fault in faults(dict(command.arguments), schema):
        raise BadCommandError(f"`{command.skill}`: {fault.message}" + (f" ({fault.hint})" if fault.hint else ""))


def read_added(p: CommandParameters) -> Do:
    arguments = p.values.get("arguments")
    if not isinstance(arguments, Mapping | None):
        raise BadCommandError("the `arguments` of `do` must be an object with names and values")
    skill = p.text("skill")
    command = Do(skill, {}, p.project.sections, p.project.verbs.get(skill))
    command = replace(command, arguments=arguments_of(added_verb(command), arguments or {}))
    check_arguments(command)
    return command
