"""The routing keys between a robot and its brain, unless the project's routes name others."""

from typing import Any

from lumen.language.causes import UNKNOWN_ORIGIN, MessageOrigin
from lumen.language.projects import Project
from lumen.ports import Bus

COMMAND_ROUTE, STOP_ROUTE, AIM_ROUTE, REPORT_ROUTE, NOTICED_ROUTE = "command", "stop", "aim", "report", "noticed"
HALL_ROUTE, SEEN_ROUTE, TEXT_ROUTE, RECORDING_ROUTE = "hall", "seen", "text_stream", "recording"


def publish_on(
    bus: Bus,
    project: Project,
    route: str,
    body: Any,
    *,
    reply_to: str = "",
    ttl: float | None = None,
    origin: MessageOrigin = UNKNOWN_ORIGIN,
) -> None:
    """Publish on a route, with the route's time to live, else `ttl` [s]. Raises BusError if the bus refuses."""
    row = project.routes.get(route)
    lasting = row.ttl if row and row.ttl is not None else ttl
    bus.publish(project.key_of(route), body, reply_to=reply_to, ttl=lasting, origin=origin)
