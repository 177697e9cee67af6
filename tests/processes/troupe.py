"""The parts of an exhibition, each with a bus, a clock and a loop of its own as in its own process.

Their clocks are real ones: in one loop, a member that follows the robot's time would make the robot wait for it.
"""

import threading
import time
from collections.abc import Callable
from dataclasses import replace
from io import StringIO
from itertools import count
from pathlib import Path
from typing import Any

import lumen
from lumen.bus import Bus, connect
from lumen.bus.validated import validated
from lumen.clock.real import RealClock
from lumen.ports import Clock
from lumen.project.home import home_of
from lumen.robot.recording import RecordingRobot
from lumen.run.compose import compose
from lumen.run.loop import TICK_PERIOD
from lumen.run.making.modules import ModulesPlan
from lumen.run.parts.remote_brain import RemoteBrainPart
from lumen.run.plan import Plan
from lumen.run.presence import BRAIN, ROBOT_PART
from lumen.run.recovery.run_directory import RunDirectory
from lumen.run.setup import Setup, set_up
from tests.nodes import Printed, whole
from tests.waiting import Collector, source_of, until

SPEED = "4"
STORIES = {
    "short": """title: A short visit
at: "10:30"
steps:
  - wait: 1s
  - visitor: arrives
  - expect: {state: ask_name, said: Good morning, within: 1h}
  - says: My name is Ada
  - expect: {state: how_are_you, context: {visitor: Ada}, within: 1h}
  - says: fine
  - expect: {state: offer, within: 1h}
  - says: A photo, please
  - expect: {state: offer, played: photo, within: 1h}
  - says: No, that is all
  - expect: {played: goodbye, within: 1h}
  - visitor: leaves
  - expect: {state: idle, within: 1h}
""",
    "dancing": """title: A visitor and a dance
at: "10:30"
steps:
  - visitor: arrives
  - expect: {state: ask_name, within: 1h}
  - says: My name is Ada
  - expect: {state: how_are_you, context: {visitor: Ada}, within: 1h}
  - says: fine
  - expect: {state: offer, within: 1h}
  - says: dance
  - expect: {state: dance, within: 1h}
  - expect: {state: offer, within: 1h}
  - says: No, that is all
  - expect: {state: goodbye, context: {visitor: Ada}, within: 1h}
  - visitor: leaves
  - expect: {state: idle, within: 1h}
""",
}


PAUSE_ROUNDS = 200
"""The number of ticks of each member after which `insist` sends its message again."""


class RoundTime:
    """The outside time without the delays of a slow machine, on which a robot's clock falls behind the others.

    While each member ticks once, no more of it passes than a tick lasts at that speed, because the robot's clock
    advances by one tick.
    """

    def __init__(self) -> None:
        self._last, self._now, self._left = time.monotonic(), 0.0, 0.0
        self._asking = threading.Lock()

    def __call__(self) -> float:
        with self._asking:
            outside = time.monotonic()
            passed = min(outside - self._last, self._left)
            self._last, self._now, self._left = outside, self._now + passed, self._left - passed
            return self._now

    def begin_round(self, speed: float) -> None:
        self()
        self._left = TICK_PERIOD / speed


class RoundClock(RealClock):
    """A `RealClock` in the time of the rounds."""

    def __init__(self, outside: RoundTime, speed: float) -> None:
        super().__init__(speed=speed)
        self._outside, self._start = outside, outside()

    def now(self) -> float:
        return (self._outside() - self._start) * self.speed


class Member:
    """One process of an exhibition, with its parts."""

    def __init__(
        self, folder: Path, url: str, names: tuple[str, ...], story: str, name: str, speed: str, outside: RoundTime
    ) -> None:
        project = replace(lumen.load(folder), robot=name)
        self.run_directory = RunDirectory(folder, guest=BRAIN not in names)
        self.cast: Setup | None = set_up("recording", project, speed) if ROBOT_PART in names else None
        clock: Clock = self.cast.clock if self.cast else RoundClock(outside, float(speed))
        played = project.stories[story] if story else None
        bus = validated(connect(url), project)
        narrator = Printed(clock.now, lambda: self.services.project.machine)
        options = {"directory": self.run_directory, "operated": True, "reload": "manual", "fresh": False}
        pace = float(speed)
        plan = Plan(
            project, self.cast, bus, played, narrator, roles=names, clock=clock, speed=pace,
            options={**options, "modules": ModulesPlan(home_of(folder))},
        )  # fmt: skip
        self.services = compose(plan)
        self.process, self.brain = self.services.node, self.services.get(RemoteBrainPart)

    @property
    def body(self) -> RecordingRobot:
        assert self.cast
        assert isinstance(self.cast.robot, RecordingRobot)
        return self.cast.robot

    @property
    def states(self) -> frozenset[str]:
        """Return the active states of the behaviour; none before it has begun."""
        assert self.brain
        snapshot = self.brain.behavior.loop.runtime._snapshot
        return snapshot.configuration if snapshot else frozenset()

    def close(self) -> None:
        self.process.close()
        self.run_directory.close(forget=True)


class Troupe:
    """Members that run while a test waits for a condition."""

    def __init__(self, folder: Path, url: str) -> None:
        self.folder, self.url, self.speed = folder, url, SPEED
        self.members: list[Member] = []
        self._killed: list[Member] = []
        self._time = RoundTime()
        self.told = StringIO()
        self.ear: Bus = connect(url)
        self.trace = Collector()
        self.ear.subscribe("lumen.NAO.state", self.trace)

    def join(self, *names: str, story: str = "", robot: str = "NAO", url: str = "") -> Member:
        member = Member(self.folder, url or self.url, names, story, robot, self.speed, self._time)
        self.members.append(member)
        return member

    def play(self) -> tuple[Member, Member]:
        """Start a robot and a brain; return both once the robot follows the brain, which is idle."""
        robot, brain = self.join("robot"), self.join("brain")
        self.until(lambda: "idle" in brain.states and robot.process.presence.find(BRAIN))
        self.rounds(5)
        return robot, brain

    def kill(self, member: Member) -> None:
        """End a member without notice to the others; its connections close, as the system would close them.

        Its threads end with the troupe.
        """
        self.members.remove(member)
        self._killed.append(member)
        member.process.bus.close()
        member.run_directory.close(forget=False)

    def until(self, condition: Callable[[], object]) -> None:
        until(condition, meanwhile=self._tick)

    def insist(self, send: Callable[[], object], condition: Callable[[], object]) -> None:
        """Send a message that a slow machine may deliver too late, again and again until the condition holds."""
        rounds = count()

        def holds() -> object:
            return condition() or ((next(rounds) % PAUSE_ROUNDS or send()) and False)

        until(holds, meanwhile=self._tick, what=source_of(condition))

    def _tick(self) -> None:
        self._time.begin_round(float(self.speed))
        for member in self.members:
            member.process.tick()

    def live(self, seconds: float) -> None:
        """Run for this much real time [s]."""
        end = time.monotonic() + seconds
        self.until(lambda: time.monotonic() >= end)

    def rounds(self, count: int) -> None:
        """Run this many ticks of each member."""
        for _ in range(count):
            self._tick()

    def close(self) -> None:
        for member in (*self.members, *self._killed):
            member.close()
        self.ear.close()


def alone(folder: Path, name: str) -> list[object]:
    """Return the trace of the behaviour in one process."""
    project = lumen.load(folder)
    story = project.stories[name]
    show = whole(project, set_up("recording", project, "max", story), story=story)
    trace = Collector()
    show.services.bus.subscribe("lumen.state", trace)
    show.start()
    assert show.player
    while not show.player.finished:
        show.tick()
    assert not show.player.failure
    show.close()
    return deeds(trace.bodies)


def deeds(bodies: list[Any], robot: str = "NAO") -> list[Any]:
    """Return a behaviour's actions from its trace, without times and ids: states entered and left, and commands.

    Without the states of the tour's region `face`, which depend on how many faces a camera sends.
    """
    found: list[Any] = []
    for body in bodies:
        if body["robot"] == robot and "command" in body:
            found.append({name: value for name, value in body["command"].items() if name != "id"})
        elif body["robot"] == robot and body.get("entered"):
            exited, entered = ([s for s in body[key] if not s.startswith("face.")] for key in ("exited", "entered"))
            if exited or entered:
                found.append((exited, entered))
    return found
