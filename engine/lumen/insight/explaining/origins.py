"""The origin of an event from outside."""

from collections.abc import Mapping
from typing import Any, NamedTuple

from lumen.insight.explaining.history import RecordedStep
from lumen.insight.explaining.links import LinkKind
from lumen.language.causes import Cause
from lumen.language.events import Event, robot_events
from lumen.language.modules import own_module_events


class EventOrigin(NamedTuple):
    """The cause of an event, which is the last link of a chain."""

    kind: LinkKind
    text: str
    id: str = ""
    values: Mapping[str, Any] = {}


def origin(one: RecordedStep, event: Event) -> EventOrigin | None:
    """Return the cause of an event, as far as the event or the routes give it; None if it is unknown."""
    if event.cause and (said := _said(event.cause)):
        return said
    by = event.data.get("by") if isinstance(event.data, Mapping) else None
    if event.name in ("stop", "resume") and by:
        return EventOrigin("person", f"{by} requested it")
    project = one.project
    rows = [row for row in project.routes.values() if row.event == event.name] if project else []
    if project and rows:
        key = rows[0].key_for(project.robot)
        return EventOrigin("message", f"a message on {key}", "", {"key": key})
    if event.name in robot_events():
        return EventOrigin("event", "the robot detected it")
    if project and event.name in own_module_events(project.modules):
        return EventOrigin("event", "the exhibition watches this module")
    return None


def _said(cause: Cause) -> EventOrigin | None:
    """Return the cause that the event itself carries."""
    values = {key: value for key in ("key", "sender") if (value := getattr(cause, key))}
    by = f", from {cause.sender}" if cause.sender else ""
    match cause.kind:
        case "message":
            return EventOrigin("message", f"a message on {cause.key}{by}", cause.id, values)
        case "person":
            said = f"{cause.sender or 'somebody'}" + (f", by a message on {cause.key}" if cause.key else "")
            return EventOrigin("person", said, cause.id, values)
        case "file":
            return EventOrigin("file", f"the file {cause.id}", cause.id, values)
        case "start":
            return EventOrigin("start", "the run began")
        case "robot":
            return EventOrigin("event", f"the robot detected it{by}", cause.id, values)
    return None
