"""What is wrong with the data of an event that a person lets happen, by what is declared of that event."""

from collections.abc import Iterator, Mapping
from typing import Any

from lumen.bus.checking import SchemaCheck
from lumen.insight.explaining.names import machines_in
from lumen.language.controller_events import controller_events
from lumen.language.events import robot_events
from lumen.language.modules import own_module_events
from lumen.language.projects import Project


class EventData:
    """Looks at data by the schemas of a project: those under `events:`, of messages on routes, and of robots."""

    def __init__(self, project: Project) -> None:
        self.project = project
        self._checks: dict[str, list[tuple[Mapping[str, Any], SchemaCheck]]] = {}

    def wrong(self, name: str, data: Any) -> str:
        """Why an event can't have this data, as a sentence; empty where it can, or nothing is declared of it."""
        if name not in self._checks:
            self._checks[name] = [(schema, SchemaCheck(schema)) for schema in _schemas(self.project, name)]
        reasons = [(schema, check(data)) for schema, check in self._checks[name]]
        if not reasons or any(not reason for _, reason in reasons):
            return ""
        schema, reason = reasons[0]
        return f"the data of `{name}` is not as declared: {reason}{_right(schema)}"


def _schemas(project: Project, name: str) -> Iterator[Mapping[str, Any]]:
    """The JSON Schemas of that event's data; several where behaviours that run within another declare it, too."""
    own = [machine.events[name] for _, machine in machines_in(project.machine) if name in machine.events]
    routed = [project.messages.get(route.schema) for route in project.routes.values() if route.event == name]
    steady = {**controller_events(project.controllers.values()), **own_module_events(project.modules), **robot_events()}
    for schema in own or routed or [steady.get(name)]:
        if isinstance(schema, Mapping):
            yield schema


def _right(schema: Mapping[str, Any]) -> str:
    """Which fields it takes, of which types."""
    fields = schema.get("properties")
    if not isinstance(fields, Mapping) or not fields:
        return ""
    needed = schema.get("required", ())
    told = (f"`{key}`{_type(kind)}{'' if key in needed else ', which may be left out'}" for key, kind in fields.items())
    return f". It has {'; '.join(told)}"


def _type(schema: Any) -> str:
    kind = schema.get("type") if isinstance(schema, Mapping) else None
    return f" ({kind})" if isinstance(kind, str) else ""
