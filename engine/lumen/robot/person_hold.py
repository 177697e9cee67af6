"""The hold of a robot that a person stopped: it refuses every movement until a person releases it."""

from datetime import UTC, datetime
from typing import NamedTuple

from lumen.language.commands import Look, Rest
from lumen.language.events import HELD, Event
from lumen.ports import Aim, RobotCommand
from lumen.robot.command_table import row_of

HEAD_SENSORS = ("FrontTactil", "MiddleTactil", "RearTactil")
"""The tactile sensors of the head."""


class StoppedBy(NamedTuple):
    """The person who stopped a robot, and the time (UTC)."""

    by: str
    since: datetime

    @property
    def reason(self) -> str:
        """The reason why a command that moves the robot is refused."""
        return f"{self.by} stopped the robot: {HELD}"


def on_head(event: Event) -> bool:
    """Return True if the robot noticed a hand on its head."""
    return event.name == "touched" and isinstance(event.data, dict) and event.data.get("sensor") in HEAD_SENSORS


class HoldListener:
    """A listener that is notified when a person stops the robot, or lets it move again."""

    def held(self, stopped: StoppedBy | None) -> None:
        """Called when a person stops the robot, or lets it move again (None)."""

    def noticed(self, event: Event) -> None:
        """Called with the event for the behaviour: `stop` or `resume`, with the person in `by`."""


class PersonHold:
    """The person who stopped the robot (`stopped`); None if it may move.

    While the robot is held, a command that moves it is refused, whoever sends it. The hold ends with `release`, or when
    the behaviour moves the robot after a hand was on its head. While the behaviour lets the robot rest, commands of
    others that move it are refused, too.
    """

    def __init__(self, *listeners: HoldListener) -> None:
        self._listeners = listeners
        self.stopped: StoppedBy | None = None
        self._touched, self._rests = False, False

    def stop(self, by: str, since: datetime | None = None) -> None:
        """Keep the robot still; each call sends the behaviour a `stop` event.

        `since` (UTC) is by default now. If the robot is stopped already, the first person and time stay.
        """
        self._touched = False
        if self.stopped is None:
            self._change(StoppedBy(by, since or datetime.now(UTC)))
        self._notice(Event("stop", {"by": by}))

    def release(self, by: str) -> None:
        """Let the robot move again on behalf of `by`; the behaviour gets a `resume` event, and may wake the robot."""
        self._release()
        self._notice(Event("resume", {"by": by}))

    def feel(self, event: Event) -> None:
        """Receive an event of the robot: a hand on its head lets the behaviour wake it."""
        if on_head(event):
            self._touched = True

    def admit(self, command: RobotCommand, *, behavior: bool) -> str:
        """Return why a command may not begin; empty if it may.

        `behavior` is whether the behaviour sends the command. If the behaviour moves the robot after a hand was on its
        head, the hold ends.
        """
        if not row_of(command).moves:
            self._rests = self._rests or (behavior and isinstance(command, Rest))
            return ""
        if behavior and (self.stopped is None or self._touched):
            self._release()
            self._rests = self._rests and isinstance(command, Look | Aim)
            return ""
        if self.stopped:
            return self.stopped.reason
        return "" if behavior or not self._rests else f"the behaviour lets the robot rest: {HELD}"

    def _notice(self, event: Event) -> None:
        for listener in self._listeners:
            listener.noticed(event)

    def _release(self) -> None:
        if self.stopped:
            self._change(None)

    def _change(self, stopped: StoppedBy | None) -> None:
        self.stopped, self._touched = stopped, False
        for listener in self._listeners:
            listener.held(stopped)
