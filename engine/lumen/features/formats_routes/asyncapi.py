"""Writes a project's routes as an AsyncAPI 3 document: the messages that a module can send and receive."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any
from urllib.parse import urlsplit

import yaml

from lumen.features.formats_routes.skill_channels import add_skills
from lumen.language.addresses import fault_of_broker
from lumen.language.projects import Project
from lumen.language.routes import Carried, Direction, Route

ASYNCAPI_VERSION = "3.0.0"
BINDING_VERSION = "0.3.0"
"""The version of AsyncAPI's AMQP bindings."""

EXCHANGE = "amq.topic"
CARRIED_DESCRIPTIONS = {
    Carried.TELEMETRY: "Telemetry: a newer message replaces older ones.",
    Carried.COMMAND: "A command: performed within its time to live, or not at all.",
    Carried.STOP: "A stop: a command that overtakes all other messages.",
    Carried.JOURNAL: "A journal: no message is lost.",
}


def write_asyncapi(project: Project) -> str:
    """Return the document as YAML. `send` and `receive` are Lumen's actions; a module does the opposite."""
    return yaml.safe_dump(document(project), sort_keys=False, allow_unicode=True, width=120)


def document(project: Project) -> dict[str, Any]:
    """Return the document as plain data."""
    routes = project.routes.values()
    old = [route for route in routes if route.alias and project.aliases is not False]
    made: dict[str, Any] = {
        "asyncapi": ASYNCAPI_VERSION,
        "info": {
            "title": project.name,
            "version": "1.0.0",
            "description": "The messages that an exhibition sends and receives, generated from its lumen.yaml.",
        },
        "defaultContentType": "application/json",
        "servers": {"broker": _server(project.bus)},
        "channels": {route.name: _channel(route, project.robot) for route in routes}
        | {_old(route): _alias_channel(route) for route in old},
        "operations": {route.name: _operation(route, route.name) for route in routes}
        | {_old(route): _operation(route, _old(route)) for route in old},
        "components": {
            "messages": {route.name: _message(route, project) for route in routes},
            "schemas": {
                name: _schema(schema, f"#/components/schemas/{name}")
                for name, schema in project.messages.items()
                if any(route.schema == name for route in routes)
            },
        },
    }
    add_skills(made, project, channel)
    return made


def _server(url: str) -> dict[str, Any]:
    """Return the broker's address without credentials; localhost if the URL is not a valid AMQP address."""
    parts = urlsplit(url if url.startswith("amqp") and not fault_of_broker(url) else "amqp://localhost:5672/")
    host = f"{parts.hostname or 'localhost'}:{parts.port or (5671 if parts.scheme == 'amqps' else 5672)}"
    return {"host": host, "protocol": parts.scheme, "protocolVersion": "0.9.1"}


def _channel(route: Route, robot: str) -> dict[str, Any]:
    return channel(route.key, route.name, robot)


def channel(key: str, message: str, robot: str) -> dict[str, Any]:
    """Return the channel for a routing key and the name of its message; `robot` is the default for `{robot}`."""
    made: dict[str, Any] = {
        "address": key,
        "messages": {message: {"$ref": f"#/components/messages/{message}"}},
        "bindings": {
            "amqp": {
                "is": "routingKey",
                "exchange": {"name": EXCHANGE, "type": "topic", "durable": True, "autoDelete": False, "vhost": "/"},
                "bindingVersion": BINDING_VERSION,
            }
        },
    }
    if "{robot}" in key:
        made["parameters"] = {"robot": {"description": "The robot's name", "default": robot}}
    return made


def _old(route: Route) -> str:
    """Return the channel name for a route's alias."""
    return f"{route.name}.alias"


def _alias_channel(route: Route) -> dict[str, Any]:
    alias = _channel(replace(route, key=route.alias), "")
    return {**alias, "description": f"A second key of `{route.name}`, used while only one robot is on the broker."}


def _operation(route: Route, channel: str) -> dict[str, Any]:
    amqp: dict[str, Any] = {"deliveryMode": 2 if route.must_arrive else 1, "mandatory": route.must_arrive}
    if route.lifetime is not None:
        amqp["expiration"] = round(1000 * route.lifetime)
    return {
        "action": "receive" if route.direction is Direction.IN else "send",
        "channel": {"$ref": f"#/channels/{channel}"},
        "description": " ".join(_carrying(route)),
        "bindings": {"amqp": {**amqp, "bindingVersion": BINDING_VERSION}},
    }


def _carrying(route: Route) -> Iterator[str]:
    yield CARRIED_DESCRIPTIONS[route.carried]
    if route.every is not None:
        yield f"Every {route.every:g} s."
    if route.size is not None:
        yield f"Images of {route.size} pixels."
    if route.keep is not None:
        yield f"At most {route.keep} messages wait."
    if route.most is not None:
        yield f"At most {route.most:g} messages a second are accepted."
    if route.event:
        yield f"Becomes the event `{route.event}`."


def _message(route: Route, project: Project) -> dict[str, Any]:
    schema = project.messages.get(route.schema)
    title = str(schema.get("title", route.name)) if schema else route.name
    payload = {"$ref": f"#/components/schemas/{route.schema}"} if schema else {}
    return {"name": route.name, "title": title, "contentType": "application/json", "payload": payload}


def _schema(data: Any, at: str) -> Any:
    """Return a message schema without `$schema` and `$id`, and with its references relative to `at`."""
    if isinstance(data, list):
        return [_schema(item, at) for item in data]
    if not isinstance(data, dict):
        return data
    moved = {key: _schema(value, at) for key, value in data.items() if key not in ("$schema", "$id")}
    if isinstance(reference := moved.get("$ref"), str) and reference.startswith("#"):
        moved["$ref"] = at + reference[1:]
    return moved
