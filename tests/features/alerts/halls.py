"""A small exhibition that sends alerts to a server on loopback, whole or in parts on one bus, as fast as possible."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import lumen
from lumen.bus.memory import MemoryBus
from lumen.clock.real import RealClock
from lumen.clock.simulated import SimulatedClock
from lumen.language.events import Event
from lumen.ports import Clock
from lumen.project.files import read_files
from lumen.robot.recording import RecordingRobot
from lumen.run.compose import compose
from lumen.run.exhibition import Exhibition
from lumen.run.node import Node
from lumen.run.plan import Plan
from lumen.run.recovery.run_directory import RunDirectory
from lumen.run.recovery.startup import startup_project
from lumen.run.setup import Setup
from tests import ROOT
from tests.copying import copied_project
from tests.features.alerts.servers import Web
from tests.nodes import Printed
from tests.waiting import until

BASE = ROOT / "tests/lint/pages/base"
TOUR = """id: tour
initial: idle
states:
  idle:
    on: {fallen: rises}
  rises:
    do: [{posture: Stand}]
    onDone: idle
    onError: idle
"""


def files(folder: Path, web: Web) -> Path:
    """Write the files of the exhibition; its alerts have an interval of 1 ms, so repeated ones are sent too."""
    copied_project(BASE, folder)
    main = folder / "lumen.yaml"
    kept = "".join(line for line in main.read_text("utf-8").splitlines(keepends=True))
    main.write_text(f"alerts: {{interval: 1ms, to: [{{webhook: '{web.url}'}}]}}\n{kept}", "utf-8")
    for stale in (*folder.glob("behaviors/**/*.yaml"), *folder.glob("fuzzy/*.yaml")):
        stale.unlink()
    (folder / "behaviors/tour.yaml").write_text(TOUR, "utf-8")
    return folder


class NearBus(MemoryBus):
    """A shared bus in memory whose broker a test can make unreachable or short of a resource."""

    host, away, blocked = "near", False, ""

    def close(self) -> None:
        """Do nothing: the bus ends with the test."""


class Hall:
    """Exhibitions, or parts of them, that tick while a test waits for a condition."""

    def __init__(self, folder: Path, web: Web) -> None:
        self.folder, self.web, self.bus = files(folder, web), web, NearBus()
        self.robot = RecordingRobot(lumen.load(folder).body)
        self.nodes: list[Node] = []
        self.closing: list[Callable[[], None]] = []

    def whole(self, *, last_good: bool = False, **behaves: str) -> Exhibition:
        """Return an exhibition as `lumen run` makes it, or `lumen run --last-good`."""
        directory = RunDirectory(self.folder)
        if last_good:
            project = startup_project(self.folder, directory, last_good=True)
        else:
            project = lumen.load(self.folder)
            directory.begin(project, read_files(self.folder))
        self.robot = RecordingRobot(project.body, behaves)
        setup = Setup(self.robot, SimulatedClock(self.robot.advance), None)
        exhibition = Exhibition(
            Plan(
                project,
                setup,
                self.bus,
                options={"directory": directory, "reload": "auto", "fresh": False, "alerts": True},
            )
        )
        exhibition.start()
        self.nodes.append(exhibition.node)
        self.closing += [exhibition.close, lambda: directory.close(forget=False)]
        return exhibition

    def part(self, *names: str) -> Node:
        """Return a node as `lumen run --only NAMES` makes it."""
        directory = RunDirectory(self.folder, guest="brain" not in names)
        project = lumen.load(self.folder)
        clock: Clock = RealClock()
        setup: Setup | None = None
        if "robot" in names:
            self.robot = RecordingRobot(project.body)
            setup = Setup(self.robot, SimulatedClock(self.robot.advance, 1.0), None)
        narrator = Printed(clock.now, lambda: node.project.machine)
        options = {"directory": directory, "operated": True, "reload": "manual", "alerts": True}
        clock = setup.clock if setup else clock
        node = compose(
            Plan(project, setup, self.bus, narrator=narrator, roles=names, clock=clock, options=options)
        ).node
        self.nodes.append(node)
        self.closing += [node.close, lambda: directory.close(forget=False)]
        return node

    def happen(self, name: str, **data: Any) -> None:
        """Let the robot report an event."""
        self.robot._notice(Event(name, data, self.robot.time))

    def until(self, condition: Callable[[], object]) -> None:
        until(condition, meanwhile=lambda: self.live(1), shown=lambda: [body["text"] for body in self.web.bodies])

    def told(self, kind: str) -> str:
        """Wait for the first alert of that kind, and return its text without the prefix."""
        self.until(lambda: self.web.of(kind))
        text: str = self.web.of(kind)[0]["text"]
        return text.partition(": ")[2]

    def live(self, ticks: int) -> None:
        for _ in range(ticks):
            for node in self.nodes:
                node.tick()

    def kill(self, node: Node) -> None:
        """Stop ticking a node without notice, as if its process had been killed."""
        self.nodes.remove(node)

    def close(self) -> None:
        """Close all nodes; what they still had to tell is delivered."""
        for close in reversed(self.closing):
            close()
        self.closing, self.nodes = [], []
