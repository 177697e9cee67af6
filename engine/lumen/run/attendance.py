"""Wait for signs of life of a robot and its modules on the bus."""

import threading
import time
from collections.abc import Collection, Mapping
from contextlib import suppress

from lumen.errors import BusError
from lumen.language.projects import Project
from lumen.ports import Bus, Message
from lumen.run.presence import HERE, PRESENCE_PERIOD, PRESENCE_ROUTE, ROBOT_PART

PRESENCE_TIMEOUT = 4 * PRESENCE_PERIOD
"""The longest wait for a sign of life [s]: four times the period at which they are sent."""


MAX_PARTS = 20
"""The number of parts that are read from one message; the rest are ignored."""


class RobotAttendance:
    """A listener for the presence messages of a project's robot and modules, from its creation on."""

    def __init__(self, bus: Bus, project: Project) -> None:
        self._robot, self._here = project.robot, threading.Event()
        self._modules, self._received = set[str](), threading.Event()
        self.skills: Mapping[str, object] | None = None
        """The hashes of the code of the robot's skills, by skill; None until a message contains them."""
        with suppress(BusError):  # a missing permission to read is reported elsewhere
            bus.subscribe(project.key_of(PRESENCE_ROUTE), self._hear)

    def robot(self) -> bool:
        """Wait up to PRESENCE_TIMEOUT for the robot; return whether it showed a sign of life."""
        return self._here.wait(PRESENCE_TIMEOUT)

    def lacking(self, modules: Collection[str]) -> set[str]:
        """Return those `modules` that show no sign of life within PRESENCE_TIMEOUT; return early if none is missing."""
        until = time.monotonic() + PRESENCE_TIMEOUT
        while (left := set(modules) - self._modules) and time.monotonic() < until:
            self._received.wait(0.1)
            self._received.clear()
        return left

    def await_skills(self) -> Mapping[str, object] | None:
        """Wait up to PRESENCE_TIMEOUT for the hashes in `skills`, and return them; None if none arrived."""
        until = time.monotonic() + PRESENCE_TIMEOUT
        while self.skills is None and time.monotonic() < until:
            self._received.wait(0.1)
            self._received.clear()
        return self.skills

    def _hear(self, message: Message) -> None:
        match message.body:
            case {"robot": self._robot, "skills": dict(skills), "state": str(state)} if state == HERE:
                self.skills = skills
                self._received.set()
        match message.body:
            case {"robot": self._robot, "parts": list(parts), "state": str(state)} if (
                ROBOT_PART in parts and state == HERE
            ):
                self._here.set()
            case {"robot": self._robot, "parts": list(parts), "state": str(state)} if state == HERE:
                self._modules |= set(map(str, parts[:MAX_PARTS]))
                self._received.set()
