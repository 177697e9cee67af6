"""A user's robot under test: time passes for it, and each broken promise fails with a sentence."""

import json
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import NoReturn

import pytest

from lumen.errors import LumenError
from lumen.language.events import Event
from lumen.language.projects import Project
from lumen.ports import Advances, Joints, Reading, Robot, RobotCommand, Sense
from lumen.robot.bounded_robot import BoundedRobot
from lumen.run.driver import fault_of, make_robot

TICK = 0.02
"""Time between two polls, as in a run [s]."""
PATIENCE = 20.0
"""Longest time for a short command [s]."""
BLOCKING = 5.0
"""Longest time for a method [s]: a tick has 0.02 s, but a loaded machine is slow."""


class RobotTrial:
    """A new robot of a driver, as an exhibition uses it.

    A robot with a method `advance` runs in its own time, any other in real time. `now` is the time since its start [s].
    `robot` is one that was made already; `driver` is then only the name in sentences.
    """

    def __init__(self, driver: str, project: Project, robot: Robot | None = None) -> None:
        self.driver, self.project = driver, project
        self.own = make_robot(driver, project) if robot is None else robot
        self._robot = BoundedRobot(self.own, project.body, fault_of(driver))
        self.now, self._began = 0.0, time.monotonic()
        self.events: list[Event] = []
        """All events so far."""

    def start(self, id: str, command: RobotCommand) -> None:
        """Start a command under an id; fail if the robot raises or blocks."""
        with self._calling("start"):
            self._robot.start(id, command)

    def cancel(self, id: str) -> None:
        """Cancel the command with that id; fail if the robot raises or blocks."""
        with self._calling("cancel"):
            self._robot.cancel(id)

    def read(self, sense: Sense) -> Reading | None:
        """Return the reading of a sense, None if the robot does not have it."""
        with self._calling("read"):
            return self._robot.read(sense)

    def angles(self) -> dict[str, float]:
        """Return the angles of its joints now [rad; a hand 0..1]; empty for a robot that does not sense them."""
        joints = self.read(Sense.JOINT)
        return dict(zip(joints.names, joints.angles, strict=True)) if isinstance(joints, Joints) else {}

    def begun(self) -> list[str]:
        """Return the ids of commands that began since the last call."""
        with self._calling("begun"):
            return list(self._robot.begun())

    def live(self, seconds: float) -> list[Event]:
        """Let `seconds` [s] pass; return the events of that time."""
        return self.until(lambda: False, seconds)

    def until(self, done: Callable[[], bool], seconds: float = PATIENCE) -> list[Event]:
        """Let time pass until a condition holds, for at most `seconds` [s]; return the events of that time."""
        first, end = len(self.events), self.now + seconds
        while not done() and self.now < end:
            self._pass()
            with self._calling("poll"):
                found = list(self._robot.poll())
            for event in found:
                self._check(event)
            self.events += found
        return self.events[first:]

    def answers(self, id: str) -> list[str]:
        """Return the answers to a command so far, such as `done` or `error`."""
        suffix = f".command.{id}"
        return [e.name.removesuffix(suffix) for e in self.events if e.name.endswith(suffix)]

    def answered(self, *ids: str, seconds: float = PATIENCE) -> list[str]:
        """Wait until these commands are answered, and return the first answer of each; fail if one is not."""
        self.until(lambda: all(self.answers(id) for id in ids), seconds)
        for id in ids:
            if not self.answers(id):
                self.fail(f"did not answer the command `{id}` within {seconds:g} s: `poll` must return its end")
        return [self.answers(id)[0] for id in ids]

    def close(self) -> None:
        """Close the robot; harmless when repeated."""
        with self._calling("close"):
            self._robot.close()

    def fail(self, what: str) -> NoReturn:
        """Fail with a sentence about the robot: `what` begins with a verb."""
        pytest.fail(f"The robot `{self.driver}` {what}.", pytrace=False)

    def _pass(self) -> None:
        if isinstance(self.own, Advances):
            with self._calling("advance"):
                self.own.advance(TICK)
            self.now += TICK
        else:
            time.sleep(TICK)
            self.now = time.monotonic() - self._began

    def _check(self, event: Event) -> None:
        """Fail for an event that an exhibition can't use."""
        if not isinstance(event, Event):
            self.fail(f"returned {event!r} from `poll`: each must be a `lumen.language.events.Event`")
        try:
            json.dumps(event.data, allow_nan=False)
        except (TypeError, ValueError):
            self.fail(f"returned the event `{event.name}` with {event.data!r}, which is not JSON data")
        if not -TICK <= event.at <= self.now + 1.0:
            self.fail(f"returned the event `{event.name}` at {event.at:g} s, but its time is {self.now:g} s")

    @contextmanager
    def _calling(self, method: str) -> Iterator[None]:
        """Run a method; fail if it raises or blocks."""
        began = time.monotonic()
        try:
            yield
        except LumenError as error:
            pytest.fail(f"{error}"[:1].upper() + f"{error}"[1:] + ".", pytrace=False)
        except Exception as error:
            self.fail(f"raised {type(error).__name__}: {error} from `{method}`: an event must tell it instead")
        if time.monotonic() - began > BLOCKING:
            self.fail(f"spent more than {BLOCKING:g} s in `{method}`: no method may block")
