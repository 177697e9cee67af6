"""Adds the skills that modules perform to an AsyncAPI document: channels for calls and answers."""

from collections.abc import Callable, Mapping
from typing import Any

from lumen.feature import VerbRow
from lumen.language.added_verbs import PerformedByModule, argument_schema
from lumen.language.projects import Project
from lumen.language.routes import DEFAULT_COMMAND_TTL
from lumen.language.routing_keys import SKILL_ANSWER, SKILL_CALL

ANSWERS = "skill_answer"
_BINDINGS = {
    "amqp": {
        "deliveryMode": 1,
        "mandatory": False,
        "expiration": round(1000 * DEFAULT_COMMAND_TTL),
        "bindingVersion": "0.3.0",
    }
}
_CALL = {"type": "string", "description": "The call: each message about it has the same text here."}
_TEXT = {"type": "string"}


def add_skills(document: dict[str, Any], project: Project, channel: Callable[[str, str, str], dict[str, Any]]) -> None:
    """Add the channels, operations and messages for the project's skills that modules perform, if there are any.

    `channel` returns the channel for a routing key, a message name and the robot's name.
    """
    modules: dict[str, dict[str, VerbRow]] = {}
    for name, row in project.verbs.items():
        if isinstance(row.details, PerformedByModule) and row.details.module:
            modules.setdefault(row.details.module, {})[name] = row
    for module, skills in modules.items():
        name, names = f"skill.{module}", ", ".join(f"`{skill}`" for skill in skills)
        document["channels"][name] = channel(SKILL_CALL.replace("{module}", module), name, project.robot)
        document["operations"][name] = _operation("send", name, f"Calls of {names}, which the module performs.")
        document["components"]["messages"][name] = _message(name, f"Calls of the module {module}", _orders(skills))
    if modules:
        document["channels"][ANSWERS] = channel(SKILL_ANSWER, ANSWERS, project.robot)
        about = "What modules answer to calls of skills: the last message of a call has `result` or `error`."
        document["operations"][ANSWERS] = _operation("receive", ANSWERS, about)
        document["components"]["messages"][ANSWERS] = _message(ANSWERS, "Answers to calls of skills", _answers(modules))


def _operation(action: str, channel: str, description: str) -> dict[str, Any]:
    where = {"$ref": f"#/channels/{channel}"}
    return {"action": action, "channel": where, "description": description, "bindings": _BINDINGS}


def _message(name: str, title: str, payload: Mapping[str, Any]) -> dict[str, Any]:
    return {"name": name, "title": title, "contentType": "application/json", "payload": payload}


def _orders(skills: Mapping[str, VerbRow]) -> dict[str, Any]:
    """Return the JSON Schema of the messages that a module receives: calls of its skills, `cancel` and `go`."""
    calls = [
        _body(skill={"const": name, "description": row.description}, arguments=argument_schema(row))
        for name, row in skills.items()
    ]
    return {"oneOf": [*calls, _body(cancel={"const": True}), _body(go={"const": True})]}


def _answers(modules: Mapping[str, Mapping[str, VerbRow]]) -> dict[str, Any]:
    """Return the JSON Schema of the modules' answers."""
    results = [
        {**row.result, "type": "object", "title": f"The result of {name}"}
        for skills in modules.values()
        for name, row in skills.items()
    ]
    return {
        "oneOf": [
            _body(accepted={"const": True}),
            _body(result={"anyOf": results}),
            _body(error=_TEXT),
            _body(wait={"type": "number", "minimum": 0, "description": "A time by the robot's clock, in seconds."}),
            _optional(_body(progress={"type": "number"}), text=_TEXT),
            _optional(_body(say=_TEXT), language=_TEXT),
            _optional(_body(publish=_TEXT), body={}),
        ]
    }


def _body(**properties: Any) -> dict[str, Any]:
    """Return the schema of a message about a call, with these required properties."""
    return {"type": "object", "required": ["call", *properties], "properties": {"call": _CALL, **properties}}


def _optional(message: dict[str, Any], /, **properties: Any) -> dict[str, Any]:
    """Return a schema from `_body` with additional optional properties."""
    return {**message, "properties": {**message["properties"], **properties}}
