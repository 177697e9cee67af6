"""Plays a story on the recording robot, in virtual time, and keeps what happened."""

from dataclasses import dataclass, field

from lumen.bus import connect
from lumen.clocks.simulated import SimulatedClock
from lumen.interpreters.statechart import Step
from lumen.language.commands import Command, Log, Say, Start
from lumen.language.projects import Project
from lumen.language.stories import Story
from lumen.ports import Perform
from lumen.robots.recording import RecordingRobot
from lumen.runtime.exhibition import Exhibition
from lumen.runtime.perception import FaceDetector
from lumen.runtime.story import StoryPlayer
from lumen.runtime.visitor import Walker
from tests.tour.names import GUIDE

LIMIT = 600.0


@dataclass
class Run:
    """What happened: texts with their times [s], motions begun, states entered in order, errors by name, log lines."""

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


def play(project: Project, story: Story) -> Run:
    """The story played to its end, or to its failure."""
    run = Run()
    robot = RecordingRobot(project.body, story.robot)
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
            case Log(text):
                run.logged.append(text)
        player.performing(command)

    exhibition = Exhibition(
        project,
        robot,
        bus,
        SimulatedClock(robot.advance, None),
        parts=[walker.tick, FaceDetector(project, robot, bus).tick, player.tick],
        observe=observe,
        performing=performing,
        answered=player.answered,
    )
    player.attach(exhibition)
    hours, minutes = (story.clock or "10:00").split(":")
    exhibition.start(language=story.language, epoch=int(hours) * 3600.0 + int(minutes) * 60.0)
    while not player.finished and run.time < LIMIT:
        run.time = exhibition.tick()
    bus.close()
    run.failure = player.failure or ("" if player.finished else f"not finished after {LIMIT:g} s")
    run.played = [command.motion.name for _, command in robot.performed if isinstance(command, Perform)]
    return run
