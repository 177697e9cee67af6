"""Where an event from outside came from: who or what caused it."""

from collections.abc import Mapping
from typing import Any, NamedTuple

from lumen.interpreters.explaining.history import RecordedStep
from lumen.interpreters.explaining.links import LinkKind
from lumen.language.events import ROBOT_EVENTS, Event


class Origin(NamedTuple):
    """The last link of a chain."""

    kind: LinkKind
    text: str
    id: str = ""
    values: Mapping[str, Any] = {}


def origin(one: RecordedStep, event: Event) -> Origin | None:
    """What is known of the cause; None where nobody said and nothing can be told from the routes."""
    by = event.data.get("by") if isinstance(event.data, Mapping) else None
    if event.name in ("stop", "resume") and by:
        return Origin("person", f"{by} said so")
    project = one.project
    rows = [row for row in project.routes.values() if row.event == event.name] if project else []
    if project and rows:
        key = rows[0].key_for(project.robot)
        return Origin("message", f"a message on {key}", "", {"key": key})
    if event.name in ROBOT_EVENTS:
        return Origin("event", "the robot noticed it")
    return None
