"""`lumen play MOTION`: play a motion on the simulated robot, from the motion's starting posture."""

import argparse
import sys
from pathlib import Path
from typing import Any

from lumen.cli.foreign import foreign_content, one_line
from lumen.cli.formats import configure_format, one_object
from lumen.cli.model_option import configure_model, use_model
from lumen.cli.progress import ProgressListener, progress
from lumen.cli.projects import shown_project
from lumen.errors import ProjectError, UsageError
from lumen.features.simulation.filming.options import configure_size, film_path, film_size
from lumen.features.simulation.options import configure_imperfections, imperfections_of
from lumen.language.commands import Posture
from lumen.language.diagnostics import did_you_mean, has_errors
from lumen.language.motions import MotionDefinition
from lumen.language.projects import Project
from lumen.language.robots import Body
from lumen.motion.limits import overspeed
from lumen.ports import Perform, RobotCommand
from lumen.project.assembly import assemble
from lumen.project.building import motion_parts
from lumen.project.document import Document
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft, body_of
from lumen.project.files import read_files
from lumen.project.formats.conversion_findings import ForeignFileError
from lumen.project.formats.importers import endings, read_gesture
from lumen.project.motions import build_motion
from lumen.project.schema import check_schema
from lumen.project.units import unit_in_si
from lumen.run.loop import TICK_PERIOD
from lumen.run.setup import SPEEDS, set_up
from lumen.run.troubles import trouble_of_answer


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of `lumen play` to the parser."""
    parser.add_argument("motion", metavar="MOTION", help="a name in motions/, or a file: .yaml, .motion, .xar, .py")
    parser.add_argument(
        "--timeline",
        metavar="NAME",
        default="",
        help="the timeline of a .xar that has several, or the function of a .py",
    )
    parser.add_argument(
        "--retime", action="store_true", help="lengthen a .motion, .xar or .py where its joints would move too fast"
    )
    parser.add_argument(
        "--project",
        metavar="DIR",
        help="the project's folder (default: this folder or one above, else the shipped project)",
    )
    configure_model(parser)
    parser.add_argument(
        "--speed",
        choices=SPEEDS,
        default="max",
        help="speed of simulated time, as a multiple of real time (default: max)",
    )
    parser.add_argument("--video", metavar="FILE.mp4", type=Path, help="save a video of the motion (needs OpenGL)")
    configure_size(parser)
    configure_imperfections(parser)
    configure_format(parser)


def run(options: argparse.Namespace) -> int:
    """Play the motion; return the exit code: 1 if the robot fell or missed a goal, else 0.

    Raises UsageError if the robot can't play the motion, and ProjectError if a needed file has errors.
    """
    root = shown_project(options.project)
    use_model(options.model, [root])
    found = motion_parts(read_files(root))
    motion = _motion(found, options.motion, options)
    if found.settings is None or found.body is None:
        raise ProjectError(found.diagnostics)
    project = assemble(found, str(root.absolute()))
    if lacking := imperfections_of(options.imperfections):
        project = project.with_section("imperfections", lacking)
    video = film_path(options.video, "simulation")
    with one_object(options.format) as say:
        played = _played(project, motion, options.speed, video, film_size(options.size))
        say(played)
    return int(bool(played["trouble"]))


def _played(
    project: Project, motion: MotionDefinition, speed: str, video: Path | None, size: tuple[int, int]
) -> dict[str, Any]:
    """Play the motion and return the object for `--format json`. Raises UsageError if the robot can't play it."""
    player = _Player(project, speed, video, size)
    print(f"{project.robot} plays `{motion.name}` ({motion.duration:.1f} s) at {speed} × real time")
    late = _slowed(motion, project.body)
    for line in late:
        print(line, file=sys.stderr)
    try:
        with progress() as tell:
            trouble = player.perform(Posture(motion.start or "Stand", 1.0), tell)
            trouble = trouble or player.perform(Perform(motion), tell, motion.duration)
    finally:
        player.close()
    lean = player.robot.greatest_tilt
    film = str(video.absolute()) if video else None
    on_feet = not player.robot.fallen
    print(f"{'finished, on its feet' if on_feet else 'ended'}; its torso leaned {lean:.1f} deg at most")
    if trouble:
        print(trouble, file=sys.stderr)
    if film:
        print(f"wrote {film}")
    duration = round(motion.duration, 3)
    return {
        "motion": motion.name,
        "duration": duration,
        "lean": round(lean, 2),
        "late": late,
        "film": film,
        "trouble": trouble or None,
    }


class _Player:
    """The simulated robot without a runtime, which performs each command to its end before the next."""

    def __init__(self, project: Project, speed: str, video: Path | None, size: tuple[int, int]) -> None:
        from lumen.features.simulation.filming.film import Film
        from lumen.features.simulation.offers import SimulatedRobot

        chosen = set_up("simulation", project, speed)
        assert isinstance(chosen.robot, SimulatedRobot)
        self.robot, self._clock = chosen.robot, chosen.clock
        self._film = Film(video, self.robot, "close", size=size) if video else None

    def perform(self, command: RobotCommand, tell: ProgressListener, duration: float = 0.0) -> str:
        """Perform a command, about `duration` [s] long, to its end; return its trouble in words, empty for none.

        Trouble is a fall or a joint that missed its goal. `tell` receives the progress. Raises UsageError, with the
        reason, if the robot can't perform the command.
        """
        self.robot.start("play", command)
        began = self._clock.now()
        while True:
            self._clock.wait(self._clock.now() + TICK_PERIOD)
            tell(min(self._clock.now() - began, duration), duration, "s played")
            if self._film:
                self._film.tick(self._clock.now())
            for event in self.robot.poll():
                if trouble := trouble_of_answer(event):
                    return trouble.what
                if event.name == "done.command.play":
                    return ""
                if event.name == "error.command.play" and not self.robot.fallen:
                    raise UsageError(str(event.data["reason"]))

    def close(self) -> None:
        """Finish the film and close the robot."""
        if self._film:
            self._film.close()
        self.robot.close()


def _slowed(motion: MotionDefinition, body: Body) -> list[str]:
    """Return a line about each joint that can't keep up with the motion, for the joint's worst key."""
    worst = {excess.joint: excess for excess in sorted(overspeed(motion, body), key=lambda e: e.value / e.limit)}
    return [
        f"`{joint}` comes late: to get there by {excess.key.time:.2f} s it would have to move at {excess.value:.3g} "
        f"{unit_in_si(joint, body)}/s, but its limit is {excess.limit:.3g}"
        for joint, excess in worst.items()
    ]


def _motion(found: ProjectDraft, name: str, options: argparse.Namespace) -> MotionDefinition:
    """Return the motion with this name or in this file; errors in the project's other files are ignored.

    Raises UsageError if there is no such motion, ProjectError if its file has errors.
    """
    path = Path(name)
    foreign = endings("motion")
    if path.suffix.lower() in foreign:
        return _foreign(body_of(found), path, options)
    if path.suffix in (".yaml", ".yml"):
        from lumen.motion import Motion as MotionFile

        if not path.is_file():
            raise UsageError(f"no file {path}")
        return MotionFile.load(path)
    if path.is_file():
        listed = f"{', '.join(foreign[:-1])} or {foreign[-1]}"
        raise UsageError(f"{path} is not a motion: its name must end in .yaml, {listed}")
    report = found.reports.get(f"motions/{name}.yaml")
    if report and has_errors(report.diagnostics):
        raise ProjectError(report.diagnostics)
    if name not in found.motions:
        raise UsageError(f"no motion `{name}`: {did_you_mean(name, found.motions, 'motions/ has')}")
    return found.motions[name]


def _foreign(body: Body, path: Path, options: argparse.Namespace) -> MotionDefinition:
    """Return the motion in another tool's file; print findings about elements that were not converted.

    Raises UsageError or ProjectError if the file has errors.
    """
    try:
        data, diagnostics = read_gesture(
            str(path), foreign_content(path), body, timeline=options.timeline, retime=options.retime
        )
    except ForeignFileError as error:
        raise UsageError(one_line(error.diagnostic)) from None
    for diagnostic in diagnostics:
        print(diagnostic, file=sys.stderr)
    report = DocumentReport(Document(str(path), data))
    motion = build_motion(check_schema(report.document, "motion", report), report, name=path.stem, body=body)
    if motion is None or has_errors(report.diagnostics):
        raise ProjectError(report.diagnostics)
    return motion
