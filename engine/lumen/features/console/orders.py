"""The pages' commands: the role that each needs, and its message on the bus."""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from lumen.errors import UsageError
from lumen.features.console.people import Role
from lumen.features.console.robot_keys import RobotKeys
from lumen.language.operator_requests import APPROVE, AUTONOMY, EVENT, GOTO, MARK, MODEL, OperatorRequest
from lumen.run.resting import rest_body, resume_body

MAX_TEXT = 1_000
MAX_NAME = 200
REST = "rest"
LONG, SHORT = 300.0, 15.0
"""The time limits of answers [s]: LONG for commands that end when the robot is done, SHORT for others."""


class Order(NamedTuple):
    """A command as a message on the bus."""

    key: str
    body: dict[str, Any]
    timeout: float
    """The time limit for the final answer [s]."""
    outcome: Callable[[Any], str | None]
    """Returns, for an answer, why the command failed, an empty text if it succeeded, None if more answers follow."""
    note: str = ""
    """A line for the journal, for commands that bypass the behaviour; empty for others."""


Fields = Mapping[str, Any]


def robot_outcome(answer: Any) -> str | None:
    """Return why a robot's command failed, an empty text if it finished, None while it runs."""
    match answer:
        case "command finished":
            return ""
        case str():
            return answer.removeprefix("command failed: ") or "it failed"
        case {"state": "finished"}:
            return ""
        case {"state": "failed" | "cancelled" as state}:
            return str(answer.get("reason") or state)
        case _:
            return None


def verdict_outcome(answer: Any) -> str | None:
    """Return why an exhibition refused a request, an empty text if it accepted it."""
    match answer:
        case {"verdict": "refused"}:
            return str(answer.get("reason") or "it was refused")
        case {"verdict": "done", "waiting": str()}:  # it waits for a person's approval
            return ""
        case {"verdict": "done", "taken": False}:
            return str(answer.get("reason") or "nothing reacts to that event now")
        case {"verdict": str()}:
            return ""
        case _:
            return "this exhibition is running an older version of Lumen, which cannot do that"


def reload_outcome(answer: Any) -> str | None:
    """Return why an order about files was refused, an empty text if it was accepted, None if more answers follow."""
    match answer:
        case {"final": False}:
            return None
        case {"verdict": "refused"}:
            return "; ".join(map(str, answer.get("lines", ()))) or str(answer.get("reason") or "it was refused")
        case {"verdict": str()}:
            return ""
        case _:
            return "the exhibition sent an answer that the console does not understand"


def order_of(command: str, fields: Fields, keys: RobotKeys, by: str) -> Order:
    """Return the message for a command. Raises UsageError for an unknown command or a malformed field."""
    make = _MAKERS.get(command)
    if make is None:
        raise UsageError(f"there is no command `{command[:40]}`: choose one of {', '.join(NEEDS)}")
    return make(fields, keys, by)


def text_in(fields: Fields, name: str, most: int = MAX_NAME, *, needed: bool = True) -> str:
    """Return a field's text, empty if it is missing.

    Raises UsageError if it is not a string, longer than `most`, or blank although `needed`.
    """
    value = fields.get(name, "")
    if not isinstance(value, str) or len(value) > most or (needed and not value.strip()):
        raise UsageError(f"`{name}` must be a string of {'1' if needed else '0'} to {most} characters")
    return value


def _motion(body: dict[str, Any], key: str, timeout: float = LONG) -> Order:
    return Order(key, body, timeout, robot_outcome)


def _say(fields: Fields, keys: RobotKeys, by: str) -> Order:
    parameter = {"text": text_in(fields, "text", MAX_TEXT), "language": text_in(fields, "language", 40, needed=False)}
    order = _motion({"type": "texttospeech", "method": "say", "parameter": parameter}, keys.command)
    return order._replace(note=f"says “{parameter['text']}”")


def _play(fields: Fields, keys: RobotKeys, by: str) -> Order:
    name = text_in(fields, "name")
    return _motion({"type": "motion", "method": name, "parameter": {}}, keys.command)._replace(note=f"plays {name}")


def _posture(fields: Fields, keys: RobotKeys, by: str) -> Order:
    parameter = {"postureName": text_in(fields, "name"), "speed": 0.8}
    order = _motion({"type": "posture", "method": "goToPosture", "parameter": parameter}, keys.command)
    return order._replace(note=f"goes into the posture {parameter['postureName']}")


def _skill(fields: Fields, keys: RobotKeys, by: str) -> Order:
    name, arguments = text_in(fields, "name"), fields.get("arguments")
    if not isinstance(arguments, dict | None):
        raise UsageError("`arguments` must be an object, or be left out")
    body = {"type": "skill", "method": "do", "parameter": {"skill": name, "arguments": arguments or {}}}
    return _motion(body, keys.command)._replace(note=f"begins {name}")


def _question(request: OperatorRequest, **fields: Any) -> Callable[[RobotKeys], Order]:
    return lambda keys: Order(keys.operator, request(**fields), SHORT, verdict_outcome)


def _event(fields: Fields, keys: RobotKeys, by: str) -> Order:
    data = fields.get("data")
    if not (data is None or isinstance(data, dict)):
        raise UsageError("`data` must be an object, or be left out")
    return _question(EVENT, event=text_in(fields, "event"), data=data or {}, by=by)(keys)


def _approve(fields: Fields, keys: RobotKeys, by: str) -> Order:
    if not isinstance(go := fields.get("go"), bool):
        raise UsageError("`go` must be true or false")
    return _question(APPROVE, id=text_in(fields, "approval"), go=go, by=by)(keys)


def _autonomy(fields: Fields, keys: RobotKeys, by: str) -> Order:
    if (level := fields.get("level")) not in ("ask", "alone"):
        raise UsageError("`level` must be `ask` or `alone`")
    return _question(AUTONOMY, level=level, by=by)(keys)


def _model(fields: Fields, keys: RobotKeys, by: str) -> Order:
    if not isinstance(on := fields.get("on"), bool):
        raise UsageError("`on` must be true or false")
    return _question(MODEL, on=on, by=by)(keys)


def _files(verb: str) -> Callable[[Fields, RobotKeys, str], Order]:
    def make(fields: Fields, keys: RobotKeys, by: str) -> Order:
        if not isinstance(now := fields.get("now", False), bool):
            raise UsageError("`now` must be true or false")
        return Order(keys.config, {"command": verb, "now": now, "by": by}, LONG, reload_outcome)

    return make


NEEDS = {
    REST: Role.NOBODY,
    "event": Role.SHOW,
    "mark": Role.SHOW,
    "approve": Role.SHOW,
    "resume": Role.OPERATOR,
    "say": Role.OPERATOR,
    "motion": Role.OPERATOR,
    "posture": Role.OPERATOR,
    "skill": Role.OPERATOR,
    "goto": Role.OPERATOR,
    "autonomy": Role.OPERATOR,
    "model": Role.OPERATOR,
    "apply": Role.AUTHOR,
    "try": Role.AUTHOR,
    "refuse": Role.AUTHOR,
    "rollback": Role.AUTHOR,
    "reload": Role.AUTHOR,
    "dry-run": Role.AUTHOR,
}
"""The commands, and the role that each needs."""

_MAKERS: dict[str, Callable[[Fields, RobotKeys, str], Order]] = {
    REST: lambda fields, keys, by: _motion(rest_body(by), keys.stop),
    "resume": lambda fields, keys, by: _motion(resume_body(by), keys.stop, SHORT),
    "say": _say,
    "motion": _play,
    "posture": _posture,
    "skill": _skill,
    "event": _event,
    "goto": lambda fields, keys, by: _question(GOTO, state=text_in(fields, "state"), by=by)(keys),
    "mark": lambda fields, keys, by: _question(MARK, text=text_in(fields, "text", MAX_NAME, needed=False), by=by)(keys),
    "approve": _approve,
    "autonomy": _autonomy,
    "model": _model,
    **{verb: _files(verb) for verb in ("apply", "try", "refuse", "rollback", "reload", "dry-run")},
}
