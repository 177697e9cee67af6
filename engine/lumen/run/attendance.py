"""Whether a robot says that it is there, while somebody looks at its bus."""

import threading
from contextlib import suppress

from lumen.errors import BusError
from lumen.language.projects import Project
from lumen.ports import Bus, Message
from lumen.run.presence import HERE, PRESENCE_PERIOD, PRESENCE_ROUTE, ROBOT_PART

PRESENCE_TIMEOUT = 4 * PRESENCE_PERIOD


class RobotAttendance:
    """Listens for the presence of a project's robot from now on."""

    def __init__(self, bus: Bus, project: Project) -> None:
        self._robot, self._here = project.robot, threading.Event()
        with suppress(BusError):  # who may not read it is told so elsewhere
            bus.subscribe(project.key_of(PRESENCE_ROUTE), self._hear)

    def robot(self) -> bool:
        """Whether it is there; waits for as long as it may take to say so."""
        return self._here.wait(PRESENCE_TIMEOUT)

    def _hear(self, message: Message) -> None:
        match message.body:
            case {"robot": self._robot, "parts": list(parts), "state": str(state)} if (
                ROBOT_PART in parts and state == HERE
            ):
                self._here.set()
