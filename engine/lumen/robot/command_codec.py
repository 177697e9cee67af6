"""Commands as JSON: those of the modules of 2015, misspellings included, and those that Lumen added.

A body is `{"type": …, "method": …, "parameter": {…}}`; the C# modules wrote `Method`. Names of keys and methods compare
case-insensitively. A method is found by its name, whatever its type. Any other name is that of a motion, or the name
that a motion had in 2015. Methods come first, so a motion called `rest` does not keep the robot from resting. Lumen
added `stop`, `look` and `perform`, which contains its motion.
"""

from collections.abc import Callable, Mapping
from typing import Any

from lumen.errors import BadCommandError, RobotRefusedError
from lumen.language.commands import Language, Move, Posture, Stop
from lumen.language.diagnostics import did_you_mean
from lumen.language.projects import Project
from lumen.ports import Aim, Perform, RobotCommand
from lumen.robot.command_checks import aimed
from lumen.robot.command_parameters import CommandParameters, PoseSource, lowered, shown
from lumen.robot.command_table import COMMANDS, row_of

MOTION_NAMES_2015 = {"dancing": "dance", "singing": "sing", "photopose": "photo"}
STOPPING_METHODS = ("rest", "stopmove", "stop")
UNSUPPORTED_METHODS = ("setstiffnesses", "setwalkarmsenabled", "sendremotebuffertooutput")
MAX_ID_LENGTH = 200
"""The number of characters of an id that are kept."""


def encode_command(command: RobotCommand) -> dict[str, Any]:
    """Return the body of a command, spelt as in 2015 if the command existed then."""
    row = row_of(command)
    return {"type": row.kind, "method": row.method, "parameter": dict(row.encode(command))}


def decode_command(body: Any, project: Project, pose: PoseSource = dict) -> RobotCommand | Language:
    """Return the command in a body; `pose` returns the joints' present angles [rad], which only `changeangle` needs.

    `setlanguage` becomes a `Language`, for the owner of the language. Raises BadCommandError, naming the allowed
    values, for a method that is unknown or impossible, and for a parameter that is missing or wrong; RobotRefusedError
    for a relative change of a joint whose angle is unknown.
    """
    order = lowered(body, "a command")
    method = order.get("method")
    if not isinstance(method, str):
        raise BadCommandError("a command needs a `method`, like `say` or `goodbye`")
    return _decode(CommandParameters(method.strip().lower(), order.get("parameter"), project, pose))


def method_of(body: Any) -> str:
    """Return the method of a body in lower case; empty if the body has no method."""
    method = lowered(body, "a command").get("method") if isinstance(body, Mapping) else None
    return shown(method.strip().lower()) if isinstance(method, str) else ""


def own_id(body: Any) -> str:
    """Return the id that the sender gave a command, cut to MAX_ID_LENGTH; empty if it gave none."""
    id = body.get("id") if isinstance(body, Mapping) else None
    return id[:MAX_ID_LENGTH] if isinstance(id, str) else ""


def stops(body: Any) -> bool:
    """Return True if a body orders the robot to rest or to stop, which nothing may delay."""
    return method_of(body) in STOPPING_METHODS


def stops_all(body: Any) -> bool:
    """Return True if a body orders the robot to end all its commands."""
    if not stops(body):
        return False
    parameter = lowered(body, "a command").get("parameter")
    what = lowered(parameter, "it").get("what") if isinstance(parameter, Mapping) else None
    return method_of(body) != "stop" or what in (None, "all")


def _decode(p: CommandParameters) -> RobotCommand | Language:
    if decode := _METHODS.get(p.method):
        return decode(p)
    motions = {name.lower(): motion for name, motion in p.project.motions.items()}
    if motion := motions.get(p.method) or motions.get(MOTION_NAMES_2015.get(p.method, "")):
        return Perform(motion)
    if p.method in UNSUPPORTED_METHODS:
        raise BadCommandError(f"this robot cannot do `{p.method}`")
    known = [*_METHODS, *MOTION_NAMES_2015, *p.project.motions]
    raise BadCommandError(f"there is no method `{shown(p.method)}`: {did_you_mean(shown(p.method), known)}")


def _set_language(p: CommandParameters) -> Language:
    if not p.text("language"):
        raise BadCommandError("`setlanguage` needs a `language`")
    return Language(p.language("language"))


def _change_angles(p: CommandParameters) -> Aim:
    changes = p.joints()
    pose = p.pose()
    if missing := [name for name in changes if name not in pose]:
        raise RobotRefusedError(f"the angle of `{missing[0]}` is unknown")
    return aimed(p, {name: pose[name] + change for name, change in changes.items()})


def _hand(p: CommandParameters, opening: float) -> Aim:
    return aimed(p, {p.joint(p.text("handname")): opening})


def _move_toward(p: CommandParameters) -> Move:
    """Return the walk at the given fractions of the greatest speeds, as in NAOqi.

    The greatest speeds are those of the brisk pace.
    """
    from lumen.motion.gait import fastest_of  # imports numpy, which only this command needs

    given = p.number("x", 0.0), p.number("y", 0.0), p.turn()
    most = fastest_of(p.project.body, "brisk")
    return Move(*(min(max(part, -1.0), 1.0) * limit for part, limit in zip(given, most, strict=True)))


_METHODS: Mapping[str, Callable[[CommandParameters], RobotCommand | Language]] = {
    **{row.method.lower(): row.decode for row in COMMANDS},
    "stopmove": lambda p: Stop(),
    "moveinit": lambda p: Posture("StandInit"),
    "movetoward": _move_toward,
    "changeangle": _change_angles,
    "openhand": lambda p: _hand(p, 1.0),
    "closehand": lambda p: _hand(p, 0.0),
    "setlanguage": _set_language,
}
"""The decoders of all methods: those in the rows of the commands, and others from 2015."""
