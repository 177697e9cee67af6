"""Check an event's data, as a person entered it, against the schemas declared for that event."""

from collections.abc import Iterator, Mapping
from typing import Any

from lumen.bus.checking import SchemaCheck
from lumen.insight.explaining.names import machines_in
from lumen.language.controller_events import controller_events
from lumen.language.events import robot_events
from lumen.language.modules import own_module_events
from lumen.language.projects import Project


class EventData:
    """A checker of event data by the schemas of a project: under `events:`, of routes, and of robots."""

    def __init__(self, project: Project) -> None:
        self.project = project
        self._checks: dict[str, list[tuple[Mapping[str, Any], SchemaCheck]]] = {}

    def wrong(self, name: str, data: Any) -> str:
        """Return in a sentence why an event can't have this data; empty if it can, or no schema is declared."""
        if name not in self._checks:
            self._checks[name] = [(schema, SchemaCheck(schema)) for schema in _schemas(self.project, name)]
        reasons = [(schema, check(data)) for schema, check in self._checks[name]]
        if not reasons or any(not reason for _, reason in reasons):
            return ""
        schema, reason = reasons[0]
        return f"the data of `{name}` is not as declared: {reason}{_right(schema)}"


def _schemas(project: Project, name: str) -> Iterator[Mapping[str, Any]]:
    """Yield the JSON Schemas of an event's data; several if invoked behaviours declare it too."""
    own = [machine.events[name] for _, machine in machines_in(project.machine) if name in machine.events]
    routed = [project.messages.get(route.schema) for route in project.routes.values() if route.event == name]
    steady = {**controller_events(project.controllers.values()), **own_module_events(project.modules), **robot_events()}
    for schema in own or routed or [steady.get(name)]:
        if isinstance(schema, Mapping):
            yield schema


def _right(schema: Mapping[str, Any]) -> str:
    """Return a sentence that lists the allowed fields and their types, empty if the schema has none."""
    fields = schema.get("properties")
    if not isinstance(fields, Mapping) or not fields:
        return ""
    needed = schema.get("required", ())
    told = (f"`{key}`{_type(kind)}{'' if key in needed else ', which may be left out'}" for key, kind in fields.items())
    return f". It has {'; '.join(told)}"


def _type(schema: Any) -> str:
    kind = schema.get("type") if isinstance(schema, Mapping) else None
    return f" ({kind})" if isinstance(kind, str) else ""
