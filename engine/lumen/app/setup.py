"""Who plays: the robot, its clock and the hall around it, chosen by name."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from lumen.clocks.real import RealClock
from lumen.clocks.simulated import SimulatedClock
from lumen.errors import UsageError
from lumen.language.imperfections import Imperfections
from lumen.language.projects import Project
from lumen.language.stories import Story
from lumen.loading.lending import model_files
from lumen.ports import Advances, Clock, Dozes, Hall, MeasuresPace, MeetsVisitors, Robot
from lumen.robots.bounded_robot import ability
from lumen.runtime.tracking import TrackingService

ROBOTS = ("simulation", "naoqi", "recording", "remote", "none")
SPEEDS = ("1", "4", "max")
NAO = "nao.local"
VOICES = ("none", "espeak")


@dataclass(frozen=True)
class Setup:
    """A robot with its clock; `hall` is the simulated world around it, None for a robot in no world of ours.

    `blind` says why its camera has no images and what to do about it; empty where it has. `remote`: its server is
    somewhere else; `tracking` is who lets controllers follow what is seen, where that is not the exhibition itself.
    """

    robot: Robot
    clock: Clock
    hall: Hall | None
    blind: str = ""
    remote: bool = False
    tracking: TrackingService | None = None

    def hurry(self) -> None:
        """Let the clock's wait that is going on return, where it can: something can't wait."""
        if isinstance(self.clock, Dozes):
            self.clock.hurry()


def set_up(
    kind: str,
    project: Project,
    speed: str,
    story: Story | None = None,
    url: str | None = None,
    imperfections: Imperfections | None = None,
) -> Setup:
    """The robot of that name, on its feet.

    `url` is where a real one is, `imperfections` are other than the project's.
    """
    if url and kind != "naoqi":
        raise UsageError("--robot-url needs --robot naoqi")
    pace = None if speed == "max" else float(speed)
    if kind == "simulation":
        from lumen.robots.simulation import SimulatedRobot, available

        lacking = imperfections or project.section(Imperfections)
        simulated = SimulatedRobot(project.body, *model_files(project), imperfections=lacking, stage=project.stage)
        return Setup(simulated, SimulatedClock(simulated.advance, pace), simulated, available() or "")
    if kind == "recording":
        from lumen.robots.recording import RecordingRobot

        recording = RecordingRobot(project.body, *((story.robot, story.results) if story else ()))
        return Setup(recording, SimulatedClock(recording.advance, pace), recording)
    if kind == "naoqi":
        from lumen.robots.naoqi import NaoqiRobot, PhysicalHall

        if speed != "1":
            raise UsageError("a real robot runs in real time: leave out --speed")
        if story:
            raise UsageError("a story needs a simulated visitor: leave out --robot naoqi")
        clock = RealClock()
        return Setup(NaoqiRobot(project.body, url or NAO, clock.now, stage=project.stage), clock, PhysicalHall())
    if kind == "none":
        from lumen.robots.none import NoRobot

        if speed != "1":
            raise UsageError("without a robot there is nothing to simulate: leave out --speed")
        return Setup(NoRobot(), RealClock(), None)
    raise UsageError(f"no robot `{kind}`: there are {', '.join(ROBOTS)}")


def set_up_with(robot: Robot, clock: Clock | None = None, pace: float | None = None) -> Setup:
    """A robot that somebody made, on their clock; without one on its own time, `pace` times real time at most.

    A robot that can `advance` lives through the time that passes; one that has a face before it (`face`) is its own
    hall. One that can neither has the time of the world outside.
    """
    hall: Any = ability(robot, MeetsVisitors)
    living = ability(robot, Advances)
    advance = living.advance if living else None
    if clock is None:
        return Setup(robot, SimulatedClock(advance, pace) if advance else RealClock(), hall)
    return Setup(robot, _DrivenClock(clock, advance) if advance else clock, hall)


class _DrivenClock:
    """Somebody's clock, through whose time a world lives."""

    def __init__(self, clock: Clock, live: Callable[[float], None]) -> None:
        self._clock, self._live, self._lived = clock, live, clock.now()

    @property
    def realtime(self) -> float:
        return self._clock.realtime if isinstance(self._clock, MeasuresPace) else 1.0

    def now(self) -> float:
        return self._clock.now()

    def wait(self, until: float) -> None:
        """All that passes is lived through, also what passes while the world lives and nobody waits."""
        self._clock.wait(until)
        lived, self._lived = self._lived, self._clock.now()
        self._live(self._lived - lived)
