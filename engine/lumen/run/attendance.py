"""The signs of life of a robot and its modules, while a program listens to the bus."""

import threading
import time
from collections.abc import Collection
from contextlib import suppress

from lumen.errors import BusError
from lumen.language.projects import Project
from lumen.ports import Bus, Message
from lumen.run.presence import HERE, PRESENCE_PERIOD, PRESENCE_ROUTE, ROBOT_PART

PRESENCE_TIMEOUT = 4 * PRESENCE_PERIOD


MAX_PARTS = 20
"""Parts of a process that are noted."""


class RobotAttendance:
    """Listens for the presence of a project's robot and modules from now on."""

    def __init__(self, bus: Bus, project: Project) -> None:
        self._robot, self._here = project.robot, threading.Event()
        self._modules, self._came = set[str](), threading.Event()
        with suppress(BusError):  # who may not read it is told so elsewhere
            bus.subscribe(project.key_of(PRESENCE_ROUTE), self._hear)

    def robot(self) -> bool:
        """Whether it is there; waits for as long as it may take to say so."""
        return self._here.wait(PRESENCE_TIMEOUT)

    def lacking(self, modules: Collection[str]) -> set[str]:
        """Return those of these modules that show no sign of life within the time that one may take to."""
        until = time.monotonic() + PRESENCE_TIMEOUT
        while (left := set(modules) - self._modules) and time.monotonic() < until:
            self._came.wait(0.1)
            self._came.clear()
        return left

    def _hear(self, message: Message) -> None:
        match message.body:
            case {"robot": self._robot, "parts": list(parts), "state": str(state)} if (
                ROBOT_PART in parts and state == HERE
            ):
                self._here.set()
            case {"robot": self._robot, "parts": list(parts), "state": str(state)} if state == HERE:
                self._modules |= set(map(str, parts[:MAX_PARTS]))
                self._came.set()
