"""The part that films a simulated robot."""

import os
import subprocess
import tempfile
from collections.abc import Sequence
from pathlib import Path

from lumen.errors import RobotFailedError, UsageError
from lumen.features.simulation.filming.options import FILM_SIZE, FilmPlan
from lumen.features.simulation.filming.progress import FilmProgress
from lumen.language.commands import Command, Play, Say, Start
from lumen.language.events import Event
from lumen.language.stories import Arrive, Leave, Speak, VisitorAction
from lumen.ports import Robot
from lumen.run.audio_track import AudioTrack
from lumen.run.loop import Observer
from lumen.run.narrator import Narrator
from lumen.run.parts.part import Part
from lumen.run.services import Services
from lumen.run.sound import save
from lumen.upkeep.own_folders import private_folder


def add_sound(film: Path, track: AudioTrack, length: float) -> None:
    """Add `length` [s] of the soundtrack to an MP4, as AAC; the pictures stay the same.

    Raises RobotFailedError if ffmpeg fails.
    """
    import imageio_ffmpeg

    with tempfile.TemporaryDirectory(dir=film.parent, prefix=".lumen-film-") as folder:
        private_folder(Path(folder))
        heard, whole = Path(folder, "heard.wav"), Path(folder, "whole.mp4")
        save(heard, track.mixed(length))
        command = [imageio_ffmpeg.get_ffmpeg_exe(), "-v", "error", "-y", "-i", str(film), "-i", str(heard)]
        command += ["-map", "0:v", "-map", "1:a", "-c:v", "copy", "-c:a", "aac", str(whole)]
        done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True)
        if done.returncode:
            raise RobotFailedError(
                f"{film} has no sound; ffmpeg's error: {(done.stderr.strip().splitlines() or ['nothing'])[-1]}"
            )
        os.replace(whole, film)


class FilmPart(Part, Observer):
    """A part that films the run and, when closed, adds the soundtrack `track`.

    The run's events choose the camera's shot. `size` is (width, height) [px]; None for the default. Raises RobotError
    if nothing can be drawn, UsageError if the robot is not simulated.
    """

    watches = True

    def __init__(
        self,
        path: Path,
        robot: Robot,
        narrator: Narrator,
        track: AudioTrack | None = None,
        *,
        size: tuple[int, int] | None = None,
        title: str = "",
        progress: FilmProgress | None = None,
    ) -> None:
        from lumen.features.simulation.filming.film import Film
        from lumen.features.simulation.filming.shots import FilmMoment
        from lumen.features.simulation.offers import SimulatedRobot

        if not isinstance(robot, SimulatedRobot):
            raise UsageError("only the simulated robot can be recorded on video")
        self._moments = FilmMoment
        self._film, self._path, self._track = Film(path, robot, size=size or FILM_SIZE, title=title), path, track
        self._progress = progress
        narrator.watchers.append(self)
        self._saying = ""
        self._now = 0.0

    def performing(self, command: Command, now: float) -> None:
        """Show a spoken text as a subtitle; request a full shot when a motion begins."""
        match command:
            case Start(id, Say(text)):
                self._saying = id
                self._film.says(text)
            case Start(_, Play()):
                self._film.happened(self._moments.ROBOT_MOVES)

    def answered(self, event: Event) -> None:
        """Remove the subtitle when the robot has finished speaking."""
        _, answer, id = event.name.partition(".command.")
        if answer and id == self._saying:
            self._film.says("")

    def visitor_action(self, action: VisitorAction) -> None:
        """Show the visitor's words as a subtitle; request a shot for an arrival or a departure."""
        match action:
            case Arrive():
                self._film.happened(self._moments.COMES)
            case Leave():
                self._film.happened(self._moments.LEAVES)
            case Speak(text=text):
                self._film.hears(text, self._now)

    def tick(self, now: float, changes: Sequence[Event]) -> None:
        """Draw the frames that are due, and report progress."""
        self._now = now
        self._film.tick(now)
        if self._progress:
            self._progress.tick(self._film.length)

    def close(self) -> None:
        """Finish the video and add the soundtrack, if any. Raises RobotFailedError if ffmpeg fails."""
        self._film.close()
        if self._track:
            add_sound(self._path, self._track, self._film.length)
            self._track = None


def make(services: Services) -> FilmPart:
    """Make the part that writes a video. Raises RobotError or UsageError as FilmPart does."""
    wanted: FilmPlan = services.plan.options["film"]
    story = services.plan.story
    title = story.title if story else services.project.name
    robot = services.setup.robot
    return FilmPart(
        wanted.path, robot, services.narrator, wanted.track, size=wanted.size, title=title, progress=wanted.progress
    )
