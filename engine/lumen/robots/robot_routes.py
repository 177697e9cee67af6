"""Under which keys a robot and its brain talk, where the project's routes do not say otherwise."""

from collections.abc import Mapping
from typing import Any

from lumen.language.projects import Project
from lumen.ports import Bus

COMMAND, STOP, AIM, REPORT, NOTICED = "command", "stop", "aim", "report", "noticed"
HALL, SEEN, TEXT, RECORDING = "hall", "seen", "text_stream", "recording"

KEYS: Mapping[str, str] = {
    COMMAND: "avatar.{robot}.command",
    STOP: "avatar.{robot}.stop",
    AIM: "avatar.{robot}.aim",
    REPORT: "avatar.{robot}.event.command",
    NOTICED: "avatar.{robot}.event.noticed",
    RECORDING: "avatar.{robot}.data.recording",
    HALL: "avatar.{robot}.hall",
    SEEN: "avatar.{robot}.hall.seen",
}


def key_of(project: Project, route: str) -> str:
    """The key of a route, with the robot's name in it."""
    row = project.routes.get(route)
    return row.key_for(project.robot) if row else KEYS[route].replace("{robot}", project.robot)


def tell(bus: Bus, project: Project, route: str, body: Any, *, reply_to: str = "", ttl: float | None = None) -> None:
    """Publish on a route, for as long as it says, else for `ttl` [s]. Raises BusError where the bus refuses."""
    row = project.routes.get(route)
    lasting = row.ttl if row and row.ttl is not None else ttl
    bus.publish(key_of(project, route), body, reply_to=reply_to, ttl=lasting)
