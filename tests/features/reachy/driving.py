"""A Reachy Mini in real time: it lives until a condition holds."""

import os
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import lumen
from lumen.features.reachy.robot import ReachyRobot
from lumen.language.events import Event
from lumen.language.projects import Project
from lumen.ports import Joints, RobotCommand, Sense
from lumen.project.chosen_model import MODEL_VARIABLE
from tests import ROOT
from tests.features.reachy.fake import joints_in
from tests.waiting import until


def reachy_project() -> Project:
    """Return the shipped exhibition, performed by a Reachy Mini."""
    before = os.environ.get(MODEL_VARIABLE)
    os.environ[MODEL_VARIABLE] = "reachy_mini"
    try:
        return lumen.load(ROOT)
    finally:
        if before is None:
            del os.environ[MODEL_VARIABLE]
        else:
            os.environ[MODEL_VARIABLE] = before


class Driven:
    """The robot at `url`; `events` are its answers and what it noticed, `sent` the targets that it gave the link."""

    def __init__(self, project: Project, url: str, voice: str = "none", root: Path = ROOT) -> None:
        self.robot = ReachyRobot(project.body, url, time.monotonic, voice=voice, root=root)
        self.events: list[Event] = []
        self.sent: list[dict[str, float]] = []
        self._link_send = self.robot._link.send
        self.robot._link.send = self._send  # type: ignore[method-assign]

    def _send(self, target: Mapping[str, Any]) -> None:
        self.sent.append(joints_in(target))
        self._link_send(target)

    def tick(self) -> None:
        self.events += self.robot.poll()
        time.sleep(0.01)

    def until(self, condition: Callable[[], object], what: str) -> None:
        """Live until the condition holds."""
        until(condition, what=what, meanwhile=self.tick, shown=lambda: self.events[-8:])

    def answer(self, id: str, command: RobotCommand | None = None) -> Event:
        """Start a command, unless it is None because it was started before; return its answer."""
        if command is not None:
            self.robot.start(id, command)
        self.until(lambda: self._answered(id), f"the answer to {id}")
        [found] = self._answered(id)
        return found

    def names(self) -> list[str]:
        return [event.name for event in self.events]

    def joints(self) -> dict[str, float]:
        reading = self.robot.read(Sense.JOINT)
        assert isinstance(reading, Joints)
        return dict(zip(reading.names, reading.angles, strict=True))

    def close(self) -> None:
        self.robot.close()

    def _answered(self, id: str) -> list[Event]:
        return [event for event in self.events if event.name.endswith(f".command.{id}")]
