"""The verdict on a mutant: lint reports it, or it loads and its stories run; anything else is a miss."""

import signal
import traceback
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from random import Random
from types import FrameType
from typing import NamedTuple

from lumen.language.commands import Command, Play, Start
from lumen.language.diagnostics import Diagnostic
from lumen.language.projects import Project
from lumen.language.stories import Story
from lumen.lint import check_files
from lumen.lint.codes import codes
from lumen.project.document import Document
from lumen.run.loop import Observer
from lumen.run.rehearsal import rehearse
from lumen.statechart import Step

PATIENCE = 60.0
"""CPU time that lint, or a story, may take [s]."""

LONGEST = 400.0
"""Simulated time after which a story has shown that it runs [s]: a mutant may wait for hours."""

ROOT = Path("/nowhere")


class Hang(BaseException):
    """Something took more CPU time than `PATIENCE`."""


class EnoughError(Exception):
    """A story has run long enough."""


class Outcome(NamedTuple):
    """How it ended, in a word or two; `trouble` is the traceback of a miss, `said` how many findings lint had."""

    what: str
    trouble: str = ""
    said: int = 0


@contextmanager
def patience(seconds: float = PATIENCE) -> Iterator[None]:
    """Raise Hang in the body after this much CPU time [s]; works in the main thread only."""

    def ring(signum: int, frame: FrameType | None) -> None:
        raise Hang

    before = signal.signal(signal.SIGPROF, ring)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)


class Seen(Observer):
    """Collects the states that a story enters and the motions that it plays."""

    def __init__(self) -> None:
        self.names: set[str] = set()

    def stepped(self, step: Step) -> None:
        self.names.update(step.entered)

    def performing(self, command: Command, now: float) -> None:
        match command:
            case Start(_, Play(motion)):
                self.names.add(motion)


def _sound(diagnostic: Diagnostic, files: Mapping[str, bytes]) -> bool:
    """Return whether a finding has a known code and words, and points into a file."""
    place = diagnostic.place
    height = files.get(place.file, b"").decode("utf-8", "replace").count("\n") + 2
    ordered = (place.line, place.column) <= (place.end_line, place.end_column)
    return bool(diagnostic.message) and diagnostic.code in codes() and ordered and 1 <= place.line <= height


class Judge:
    """Judges mutants of a project; it has seen its stories, and knows which of them a change may touch."""

    def __init__(self, files: Mapping[str, bytes], stories: int) -> None:
        project, found = check_files(ROOT, files)
        assert project, found
        self._project, self._most = project, stories
        self._seen: dict[str, set[str]] = {}
        for story in project.stories.values():
            seen = Seen()
            rehearse(project, story, observers=[seen])
            self._seen[story.name] = seen.names

    def judge(self, file: str, line: int, files: Mapping[str, bytes], random: Random) -> Outcome:
        """Return the outcome of a mutant that differs first in that line of that file."""
        try:
            with patience():
                project, diagnostics = check_files(ROOT, files)
        except Hang:
            return Outcome("lint hangs", traceback.format_exc(limit=-12))
        except Exception:
            return Outcome("lint crashes", traceback.format_exc(limit=-12))
        if astray := [d for d in diagnostics if not _sound(d, files)]:
            return Outcome("nonsense said", str(astray[0]))
        if project is None:
            return Outcome("error found" if diagnostics else "refused without a word", said=len(diagnostics))
        for story in self._touched(project, file, line, random):
            if trouble := self._trouble(project, story):
                return trouble
        return Outcome("warned, and runs" if diagnostics else "clean, and runs", said=len(diagnostics))

    def _trouble(self, project: Project, story: Story) -> Outcome | None:
        def enough(now: float) -> None:
            if now > LONGEST:
                raise EnoughError

        try:
            with patience():
                failed = rehearse(project, story, hooks=[enough]).failed
        except EnoughError:
            return None
        except Hang:
            return Outcome("lint passed, run hangs", f"{story.name}\n{traceback.format_exc(limit=-12)}")
        except Exception:
            return Outcome("lint passed, run crashed", f"{story.name}\n{traceback.format_exc(limit=-12)}")
        if failed and not failed.expected:  # no story expects that: the engine gave up
            return Outcome("lint passed, run gave up", str(failed))
        return None

    def _touched(self, project: Project, file: str, line: int, random: Random) -> list[Story]:
        """Return a few stories that reach the changed line; any stories if that is unknown."""
        name = Path(file).stem
        if file.startswith("behaviors/stories/"):
            return [project.stories[name]] if name in project.stories else []
        if file.startswith("behaviors/"):
            name = self._state(file, line)
        by = [story for story in project.stories.values() if name in self._seen.get(story.name, ())]
        chosen = by or list(project.stories.values())
        return random.sample(chosen, min(self._most, len(chosen)))

    def _state(self, file: str, line: int) -> str:
        """Return the innermost state around a line of the unchanged project."""
        document = self._project.documents[file]
        assert isinstance(document, Document)
        around = [
            state
            for state in self._project.machine.states.values()
            if state.path and document.place(state.where).line <= line <= document.place(state.where).end_line
        ]
        return max(around, key=lambda state: len(state.where)).name if around else ""
