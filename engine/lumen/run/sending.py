"""Messages on a project's routes, sent from the loop: a failure is returned as a reason, not raised."""

from typing import Any

from lumen.errors import BusError
from lumen.language.causes import UNKNOWN_ORIGIN, MessageOrigin
from lumen.language.projects import Project
from lumen.ports import Bus


def send(bus: Bus, project: Project, route: str, body: Any, origin: MessageOrigin = UNKNOWN_ORIGIN) -> str:
    """Publish a body on a route; return why that failed, else an empty string."""
    if route not in project.routes:
        return f"there is no route `{route}`"
    try:
        row = project.routes[route]
        bus.publish(row.key_for(project.robot), body, ttl=row.ttl, origin=origin)
    except BusError as error:
        return str(error)
    return ""
