"""Plays a story in virtual time, on the recording robot or another, and keeps what happened."""

from dataclasses import dataclass, field
from typing import Protocol

from lumen.bus import connect
from lumen.clocks.simulated import SimulatedClock
from lumen.interpreters.statechart import Step
from lumen.language.commands import Command, Log, Play, Say, Start
from lumen.language.events import Event
from lumen.language.projects import Project
from lumen.language.stories import Story
from lumen.ports import Hall, Robot
from lumen.robots.recording import RecordingRobot
from lumen.runtime.exhibition import Exhibition, Part
from lumen.runtime.perception import FaceDetector
from lumen.runtime.story import StoryPlayer
from lumen.runtime.visitor import Walker
from tests.tour.names import GUIDE

LIMIT = 600.0


@dataclass
class Run:
    """What happened: texts with their times [s], motions finished, states entered, errors by name, log lines."""

    failure: str = ""
    time: float = 0.0
    said: list[tuple[float, str]] = field(default_factory=list)
    played: list[str] = field(default_factory=list)
    entered: list[str] = field(default_factory=list)
    errors: list[str] = field(default_factory=list)
    logged: list[str] = field(default_factory=list)

    def guide(self) -> list[str]:
        """The tour's states in the order entered."""
        return [name for name in self.entered if name in GUIDE]


class Performer(Robot, Hall, Protocol):
    """A robot in a world of ours; `advance` lets [s] pass."""

    def advance(self, dt: float) -> None: ...


def play(project: Project, story: Story, performer: Performer | None = None, *, part: Part | None = None) -> Run:
    """The story played to its end, or to its failure; `part` lives with it."""
    run = Run()
    playing: dict[str, str] = {}
    robot = performer or RecordingRobot(project.body, story.robot)
    bus = connect("memory://", project)
    walker = Walker(project, robot, bus)
    player = StoryPlayer(story, project, robot, bus, walker)

    def observe(step: Step) -> None:
        run.entered += step.entered
        run.errors += [event.name for event in step.raised if event.name.startswith("error.")]
        player.observe(step)

    def performing(command: Command, now: float) -> None:
        match command:
            case Start(_, Say(text)):
                run.said.append((now, text))
            case Start(id, Play(motion)):
                playing[id] = motion
            case Log(text):
                run.logged.append(text)
        player.performing(command)

    def answered(event: Event) -> None:
        kind, _, id = event.name.partition(".command.")
        if kind == "done" and id in playing:
            run.played.append(playing[id])
        player.answered(event)

    exhibition = Exhibition(
        project,
        robot,
        bus,
        SimulatedClock(robot.advance, None),
        parts=[walker.tick, FaceDetector(project, robot, bus).tick, player.tick, *([part] if part else [])],
        observe=observe,
        performing=performing,
        answered=answered,
    )
    player.attach(exhibition)
    hours, minutes = (story.clock or "10:00").split(":")
    exhibition.start(language=story.language, epoch=int(hours) * 3600.0 + int(minutes) * 60.0)
    while not player.finished and run.time < LIMIT:
        run.time = exhibition.tick()
    bus.close()
    run.failure = player.failure or ("" if player.finished else f"not finished after {LIMIT:g} s")
    return run
