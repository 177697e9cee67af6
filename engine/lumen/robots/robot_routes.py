"""Under which keys a robot and its brain talk, where the project's routes do not say otherwise."""

from collections.abc import Mapping
from typing import Any

from lumen.language.projects import Project
from lumen.ports import Bus

COMMAND_ROUTE, STOP_ROUTE, AIM_ROUTE, REPORT_ROUTE, NOTICED_ROUTE = "command", "stop", "aim", "report", "noticed"
HALL_ROUTE, SEEN_ROUTE, TEXT_ROUTE, RECORDING_ROUTE = "hall", "seen", "text_stream", "recording"

DEFAULT_KEYS: Mapping[str, str] = {
    COMMAND_ROUTE: "avatar.{robot}.command",
    STOP_ROUTE: "avatar.{robot}.stop",
    AIM_ROUTE: "avatar.{robot}.aim",
    REPORT_ROUTE: "avatar.{robot}.event.command",
    NOTICED_ROUTE: "avatar.{robot}.event.noticed",
    RECORDING_ROUTE: "avatar.{robot}.data.recording",
    HALL_ROUTE: "avatar.{robot}.hall",
    SEEN_ROUTE: "avatar.{robot}.hall.seen",
}


def key_of(project: Project, route: str) -> str:
    """The key of a route, with the robot's name in it."""
    row = project.routes.get(route)
    return row.key_for(project.robot) if row else DEFAULT_KEYS[route].replace("{robot}", project.robot)


def publish_on(
    bus: Bus, project: Project, route: str, body: Any, *, reply_to: str = "", ttl: float | None = None
) -> None:
    """Publish on a route, for as long as it says, else for `ttl` [s]. Raises BusError where the bus refuses."""
    row = project.routes.get(route)
    lasting = row.ttl if row and row.ttl is not None else ttl
    bus.publish(key_of(project, route), body, reply_to=reply_to, ttl=lasting)
