"""A robot's executor with the workshop of a project's skills, whose clock is real or stands still."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import Thread
from typing import Any

from lumen.bus.memory import MemoryBus
from lumen.features.skills.workshop import Workshop, register
from lumen.language.commands import Do
from lumen.language.events import RESULT, Event
from lumen.ports import Bus
from lumen.project import load
from lumen.robot.command_table import parts_of
from lumen.robot.executor import Executor
from lumen.robot.skill_runner import SkillRunner
from tests.exhibits import BODY
from tests.robots.test_executor import Fake
from tests.waiting import threads, until


class Stage:
    """`told` are the lines about skills, `reported` their troubles; `start` begins a skill, `end` waits for its end."""

    def __init__(self, root: Path, bus: Bus | None = None) -> None:
        self.root, self.project, self.bus = root, load(root), bus or MemoryBus()
        self.told: list[str] = []
        self.reported: list[str] = []
        self.events: dict[str, Event] = {}
        self.workshop = Workshop(
            self.project, self.bus, lambda _, line: self.told.append(line), lambda _, line: self.reported.append(line)
        )
        self.runner = SkillRunner()
        self.executor = Executor(lambda c, now: Fake(c, now, 0.0), lambda c: parts_of(c, BODY), self.runner.begin)
        self.began = time.monotonic()
        self._count = 0

    def start(self, skill: str, **arguments: Any) -> str:
        """Begin a skill; return its id."""
        self._count += 1
        id = f"d{self._count}"
        self.executor.start(id, self.command(skill, **arguments))
        self.tick()
        return id

    def command(self, skill: str, **arguments: Any) -> Do:
        return Do(skill, arguments, row=self.project.verbs[skill])

    def tick(self) -> None:
        for event in self.executor.advance(time.monotonic() - self.began):
            self.events[event.name.rpartition(".")[2]] = event

    def end(self, id: str) -> Any:
        """Wait for the end of a command; return its result, the reason why it failed, or `cancelled`."""
        self.until(lambda: id in self.events)
        event = self.events[id]
        data = event.data or {}
        return data.get(RESULT, {}) if event.name.startswith("done") else data.get("reason", "cancelled")

    def perform(self, skill: str, **arguments: Any) -> Any:
        return self.end(self.start(skill, **arguments))

    def until(self, condition: Callable[[], object]) -> None:
        """Let the robot live until the condition holds."""

        def holds() -> object:
            self.tick()
            return condition()

        until(holds, shown=lambda: "\n".join((*self.told, *self.reported)))

    def until_told(self, text: str) -> None:
        self.until(lambda: any(text in line for line in (*self.told, *self.reported)))

    def write(self, file: str, text: str) -> None:
        """Save a file at once, so that nothing reads a half of it."""
        draft = self.root / f"{file}.new"
        draft.parent.mkdir(exist_ok=True)
        draft.write_text(text, "utf-8")
        draft.rename(self.root / file)


@contextmanager
def stage(root: Path, bus: Bus | None = None) -> Iterator[Stage]:
    others = skill_threads()  # of an exhibition that other tests of the file share
    made = Stage(root, bus)
    unregister = register(made.workshop)
    try:
        yield made
    finally:
        made.runner.close()
        unregister()
        made.workshop.close()
        until(lambda: skill_threads() <= others)


def skill_threads() -> set[Thread]:
    """Return the threads that perform skills, and those that read what programs of skills print."""
    return threads("lumen-skill-") | threads("lumen-program-")
