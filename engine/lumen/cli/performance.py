"""An exhibition that runs on a terminal: its introduction, transcript and summary."""

import math
import time
from collections.abc import Sequence
from pathlib import Path

from lumen.cli.main import ready
from lumen.cli.printing import clock_time
from lumen.cli.run_plan import leave, running
from lumen.cli.run_verdict import ENDED, FAILED, RunVerdict, end_of, troubles_of
from lumen.cli.transcript import Transcript
from lumen.clock.real import RealClock
from lumen.language.projects import Project
from lumen.language.stories import Leave, VisitorAction
from lumen.run.parts.robot import RobotPart
from lumen.run.recovery.run_directory import RunDirectory
from lumen.run.services import Services
from lumen.run.setup import Setup

GREETING = (
    "You are the visitor: type what you say, or /help. Ctrl-D walks away; Ctrl-C makes the robot rest, and a second"
    " Ctrl-C ends.\n"
)


class Performance:
    """Runs a whole exhibition of one robot in this process, and prints its introduction, transcript and summary."""

    def __init__(self, setup: Setup, project: Project, made: Sequence[Services]) -> None:
        self.transcript = _VisitorsTranscript(setup, project, made)
        self._setup, self._took, self._lived = setup, 0.0, 0.0

    def introduce(self, services: Services, speed: str) -> None:
        """Print the project, robot, behaviour, speed and story.

        Warn if another process already runs the project, or if there are no camera images.
        """
        project, story = services.project, services.plan.story
        run_directory: RunDirectory = services.plan.options["directory"]
        pace = {"max": "as fast as this machine can", "1": "in real time"}.get(speed, f"at {speed} × real time")
        print(f"{project.name}: {project.robot} performs `{project.behavior}` {pace}, ready after {ready():.1f} s.")
        if run_directory.taken:
            print(
                "This project is already running in another process:"
                " commands such as `lumen reload` go to that process."
            )
        if self._setup.blind:
            print(f"The exhibition is running without camera images: {self._setup.blind}.")
        if story:
            print(f"The story is “{story.title}”.\n")

    def run(self, services: Services, period: float | None) -> None:
        """Run until the story ends, the period [s] is over, the visitor has left or the operator ends it."""
        began = time.monotonic()
        self._lived = services.node.run(period)
        self._took = time.monotonic() - began

    def summary(self, services: Services, video: Path | None) -> RunVerdict:
        """Print how the run went, and return its verdict; `video` is the file of the film, if one was made."""
        node, robot, story = services.node, services[RobotPart], services.plan.story
        troubles = troubles_of(node, judged=story is not None)
        end = end_of([services], troubles)
        stopped = robot.server.hold.stopped if story is None else None
        ended = (f"Stopped by {stopped.by}" if stopped else "All well") if end.words == ENDED else end.words
        real = isinstance(self._setup.clock, RealClock)
        pace = "" if real else f" in {self._took:.0f} s ({self._lived / max(self._took, 0.01):.1f} × real time)"
        print(f"\n{ended}: {clock_time(self._lived)} of {'simulated ' * bool(pace)}time{pace}.")
        if end.ended == FAILED:
            print(f"  {end.failure}")
        lines = [*RunVerdict.listed(troubles), self.transcript.counted()]
        if self.transcript.distance is not None:
            lines.append(
                f"the visitor's face ended {self.transcript.distance:.0f} px from the centre of the camera's image"
            )
        lines += [*robot.summary(), *node.losses()]
        film = str(video.absolute()) if video else ""
        for line in [*lines, *([f"wrote the video {film}"] if film else [])]:
            print(f"  {line}")
        print(f"Next: change a sentence in behaviors/{services.project.behavior}.yaml during a run,")
        print("      `lumen run` to be the visitor yourself, `lumen lint` after every change, `lumen graph` to see it.")
        if story and not film:
            print(f"      `lumen run --story {story.name} --speed max --video {story.name}.mp4` makes a video of this.")
        return RunVerdict(end.ended, self._lived, self._took, end.failure, tuple(lines), film)


class _VisitorsTranscript(Transcript):
    """A transcript that records where the visitor's face was in the camera image when the visitor left."""

    distance: float | None = None

    def __init__(self, setup: Setup, project: Project, made: Sequence[Services]) -> None:
        super().__init__(setup.clock.now, lambda: running(made, project).machine, unread=lambda: leave(made))
        self._made = made

    def visitor_action(self, action: VisitorAction) -> None:
        super().visitor_action(action)
        if isinstance(action, Leave) and (distance := self._look_back()) is not None:
            self.distance = distance

    def _look_back(self) -> float | None:
        """Return the distance between the visitor's last seen face and the image's centre [px]; None without a face."""
        faces = self._made[0][RobotPart].faces
        if faces is None or faces.last is None or faces.camera is None:
            return None
        return math.dist(faces.last, (faces.camera.width / 2, faces.camera.height / 2))
