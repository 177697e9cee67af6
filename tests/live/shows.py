"""A running show of a copy of the project, with files that are saved and an operator who asks."""

from collections.abc import Callable, Mapping
from io import StringIO
from pathlib import Path
from typing import Any

import lumen
from lumen.clock.simulated import SimulatedClock
from lumen.language.projects import Project
from lumen.language.stories import Visitor
from lumen.lint import check_files
from lumen.project.files import read_files
from lumen.project.home import Home
from lumen.robot.recording import RecordingRobot
from lumen.run.rehearsal import Rehearsal
from lumen.run.reload.records import RunRecords
from lumen.run.reload.reloader import Reloader, ReloadOptions
from lumen.run.reload.requests import COMMAND, STATUS
from lumen.run.reload.saved_files import ReloadPart
from lumen.run.reload.validation_process import failure
from lumen.run.reload.validation_worker import Loaded
from lumen.run.reload.visits_check import VisitsCheck, check_visits
from lumen.run.setup import Setup
from tests.nodes import Printed, whole
from tests.waiting import HANG, Collector, until

QUIET = 0.06


class Here:
    """A `FileJudge` on the calling thread, since few tests are about the process that judges files."""

    def __init__(self, root: Path) -> None:
        self._root = root

    def begin(self) -> None:
        """Do nothing: no process is needed."""

    def warm(self, files: Mapping[str, bytes]) -> None:
        """Do nothing: no files are prepared in advance."""

    def load(self, files: Mapping[str, bytes]) -> Loaded:
        return check_files(self._root, files)

    def play(self, project: Project, story: str, seconds: float) -> Rehearsal | None:
        return failure(project, story, seconds)

    def visits(self, project: Project, running: str, budget: float) -> VisitsCheck:
        return check_visits(self._root, project, running, budget)

    def close(self) -> None:
        """Do nothing: no resources are held."""


class Live:
    """A show that ticks as fast as possible while a test waits for a condition."""

    def __init__(
        self,
        folder: Path,
        mode: str = "auto",
        url: str = "memory://",
        *,
        project: Project | None = None,
        seen: str = "",
        behaves: Mapping[str, str] | None = None,
        apart: bool = False,
    ) -> None:
        self.folder = folder
        project = project or lumen.load(folder)
        self.robot = RecordingRobot(project.body, behaves)
        self.told = StringIO()
        transcript = Printed(lambda: self.show.now, lambda: self.show.project.machine)
        transcript.stream = self.told
        setup = Setup(self.robot, SimulatedClock(self.robot.advance, 20.0), self.robot)
        self.show = whole(project, setup, url, None, transcript)
        self.home = Home(folder / ".lumen")
        assert self.home.hold()
        self.records = RunRecords(self.home)
        self.records.store(read_files(folder, project.one_of_several))
        self.reloading = Reloader(
            self.show.behavior,
            transcript,
            ReloadOptions(mode, QUIET, HANG, seen),
            records=self.records,
            worker=None if apart else Here(folder),
        )
        parts = self.show.node.parts
        parts.insert(parts.index(self.show.brain), ReloadPart(self.reloading))
        self.answers = Collector()
        self.show.loop.bus.subscribe("lumen.test.answer", self.answers)
        self.status = Collector()
        self.show.loop.bus.subscribe(STATUS, self.status)
        self.show.start()

    def close(self) -> None:
        self.show.close()
        self.records.close()
        self.home.release()

    def until(self, condition: Callable[[], object]) -> None:
        until(condition, meanwhile=self.show.tick, shown=self.told.getvalue)

    def until_told(self, text: str) -> None:
        self.until(lambda: text in self.transcript)

    def live(self, seconds: float) -> None:
        """Let so much of the show's time pass [s]."""
        end = self.show.loop.clock.now() + seconds
        self.until(lambda: self.show.loop.clock.now() >= end)

    def greet(self) -> None:
        assert self.show.visitor
        self.show.visitor.arrive(Visitor())
        self.until(lambda: "ask_name" in self.states)

    def speak(self, text: str, state: str) -> None:
        assert self.show.visitor
        self.show.visitor.speak(text)
        self.until(lambda: state in self.states)

    def edit(self, old: str, new: str, file: str = "behaviors/tour.yaml", *more: str) -> None:
        """Save a file with these changes at once: a machine that stops between two writes makes no half of it."""
        path, draft, words = self.folder / file, self.folder.parent / "draft", (old, new, *more)
        text = path.read_text("utf-8")
        for before, after in zip(words[::2], words[1::2], strict=True):
            assert before in text
            text = text.replace(before, after)
        draft.write_text(text, "utf-8")
        draft.replace(path)

    def ask(self, command: object, **more: object) -> dict[str, Any]:
        """Send a command, and return the first answer to it."""
        before = len(self.answers.messages)
        body = {"command": command, **more}
        self.show.loop.bus.publish(COMMAND, body, reply_to="lumen.test.answer", correlation_id=str(before))
        self.until(lambda: len(self.answers.messages) > before)
        found: dict[str, Any] = self.answers.bodies[before]
        return found

    @property
    def transcript(self) -> str:
        return self.told.getvalue()

    @property
    def states(self) -> frozenset[str]:
        return self.show.loop.runtime.snapshot.configuration

    @property
    def verdicts(self) -> list[str]:
        return [body["verdict"] for body in self.status.bodies]
