"""A simulated visitor who walks up, speaks, touches and leaves, as visitors do in a real hall."""

import logging
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from lumen.errors import UsageError
from lumen.language.causes import VISITOR, MessageOrigin
from lumen.language.projects import Project
from lumen.language.stories import Visitor
from lumen.ports import Bus, FeelsTouch, Hall, HearsVisitors, PretendsSkills
from lumen.run.sending import send

_log = logging.getLogger(__name__)

VISITOR_SPEED = 1.0
"""The walking speed [m/s]."""
APPROACH_DISTANCE = 1.5
"""The distance that a visitor walks to arrive or leave [m]."""
SPEECH_ROUTE = "heard"


class VisitorActor:
    """A visitor who walks through the hall at VISITOR_SPEED, and speaks.

    The visitor's words are published as messages of the speech module, on the route `heard`.
    """

    def __init__(self, project: Project, hall: Hall, bus: Bus) -> None:
        self._project, self._hall, self._bus = project, hall, bus
        self._visitor: Visitor | None = None
        self._goal: Visitor | None = None
        self._leaving = False
        self._last = 0.0

    @property
    def walking(self) -> bool:
        """Whether the visitor is walking."""
        return self._goal is not None

    @property
    def sensors(self) -> tuple[str, ...]:
        """The tactile sensors that the visitor can touch; empty if the robot can't feel."""
        return self._project.body.tactile if isinstance(self._hall, FeelsTouch) else ()

    def use(self, project: Project) -> None:
        """Switch to another bundle."""
        self._project = project

    def arrive(self, visitor: Visitor) -> None:
        """Walk to the position of `visitor`, from APPROACH_DISTANCE away or from where the visitor already is."""
        if self._visitor is None:
            self._visitor = replace(visitor, x=visitor.x + APPROACH_DISTANCE)
        self._visitor = replace(self._visitor, height=visitor.height)
        self._goal, self._leaving = visitor, False

    def leave(self) -> None:
        """Walk away, and disappear."""
        if self._visitor:
            self._goal, self._leaving = replace(self._visitor, x=self._visitor.x + APPROACH_DISTANCE), True

    def speak(self, text: str, language: str = "") -> None:
        """Say a text: publish it at once, as the speech module would; a failure is only logged."""
        if isinstance(self._hall, HearsVisitors):
            self._hall.sound()
        body = {"name": "visitor", "result": text, "date": "", "language": language}
        if reason := send(self._bus, self._project, SPEECH_ROUTE, body, MessageOrigin(sender=VISITOR)):
            _log.warning("the visitor's words were not sent: %s", reason)

    def touch(self, sensor: str, pressed: bool) -> None:
        """Press or release a tactile sensor. Raises UsageError if that is impossible."""
        if not isinstance(self._hall, FeelsTouch):
            raise UsageError(f"a visitor can't touch this robot: `{type(self._hall).__name__}` has no method `touch`")
        self._hall.touch(sensor, pressed)

    def set_skills(self, ends: Mapping[str, Mapping[str, Any] | str]) -> None:
        """Set how skills end from now on. Raises UsageError if this robot can't simulate them."""
        if not isinstance(self._hall, PretendsSkills):
            raise UsageError(
                "this robot performs skills itself: play a story with `skills:` on the recording or the simulated robot"
            )
        self._hall.set_skills(ends)

    def tick(self, now: float) -> None:
        """Move the visitor by the time from the last tick to `now` [s]."""
        dt, self._last = now - self._last, now
        if self._visitor is None or self._goal is None:
            return
        self._visitor = _towards(self._visitor, self._goal, VISITOR_SPEED * dt)
        arrived = self._visitor == self._goal
        if arrived:
            self._goal = None
            if self._leaving:
                self._visitor = None
        self._hall.place(self._visitor)


def _towards(visitor: Visitor, goal: Visitor, distance: float) -> Visitor:
    dx, dy = goal.x - visitor.x, goal.y - visitor.y
    left = float((dx * dx + dy * dy) ** 0.5)
    if left <= distance:
        return goal
    return replace(visitor, x=visitor.x + dx * distance / left, y=visitor.y + dy * distance / left)
