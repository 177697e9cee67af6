"""Plays a story in virtual time, on the recording robot or another, and records the run."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Protocol

from lumen.clock.simulated import SimulatedClock
from lumen.language.commands import Command, Play, Say, Start
from lumen.language.commands import Log as LogLine
from lumen.language.events import Event
from lumen.language.projects import Project
from lumen.language.stories import Story
from lumen.ports import Hall, Robot
from lumen.run.loop import Observer
from lumen.run.rehearsal import rehearse
from lumen.run.setup import Setup
from lumen.statechart import Step
from tests.tour.names import GUIDE


@dataclass
class Run:
    """A record of a run."""

    failure: str = ""
    """Why the story failed; empty if it passed."""
    time: float = 0.0
    """The time of the end [s]."""
    said: list[tuple[float, str]] = field(default_factory=list)
    """The texts spoken, each after its time [s]."""
    played: list[str] = field(default_factory=list)
    """The names of the motions that finished."""
    entered: list[str] = field(default_factory=list)
    errors: list[str] = field(default_factory=list)
    """The names of the events of errors."""
    logged: list[str] = field(default_factory=list)

    def guide(self) -> list[str]:
        """Return the tour's states in the order in which they were entered."""
        return [name for name in self.entered if name in GUIDE]


class Performer(Robot, Hall, Protocol):
    """A robot with its hall; `advance` lets that much time pass [s]."""

    def advance(self, dt: float) -> None: ...


class Log(Observer):
    """Records its observations in a run."""

    def __init__(self, run: Run) -> None:
        self.run = run
        self.playing: dict[str, str] = {}

    def stepped(self, step: Step) -> None:
        self.run.entered += step.entered
        self.run.errors += [event.name for event in step.raised if event.name.startswith("error.")]

    def performing(self, command: Command, now: float) -> None:
        match command:
            case Start(_, Say(text)):
                self.run.said.append((now, text))
            case Start(id, Play(motion)):
                self.playing[id] = motion
            case LogLine(text):
                self.run.logged.append(text)

    def answered(self, event: Event) -> None:
        kind, _, id = event.name.partition(".command.")
        if kind == "done" and id in self.playing:
            self.run.played.append(self.playing[id])


def play(
    project: Project,
    story: Story,
    performer: Performer | None = None,
    *,
    part: Callable[[float], None] | None = None,
    observers: Sequence[Observer] = (),
) -> Run:
    """Play a story to its end, or to its failure; return the record. `part` is called with the time of each tick."""
    run = Run()
    chosen = Setup(performer, SimulatedClock(performer.advance), performer) if performer else None
    rehearsal = rehearse(project, story, chosen, observers=[Log(run), *observers], hooks=[part] if part else [])
    run.time, run.failure = rehearsal.time, str(rehearsal.failed or "")
    return run
