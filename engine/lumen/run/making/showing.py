"""The film of a run, and the console's pages."""

from dataclasses import dataclass
from pathlib import Path

from lumen.features.console.part import ConsolePart
from lumen.features.film.part import FilmPart
from lumen.features.film.progress import FilmProgress
from lumen.run.audio_track import AudioTrack
from lumen.run.making.serving import directory_of
from lumen.run.services import Services


@dataclass(frozen=True, slots=True)
class FilmPlan:
    """A video of a simulated robot: its file, sound, size (width, height) [px], and progress on the terminal."""

    path: Path
    track: AudioTrack | None = None
    size: tuple[int, int] | None = None
    progress: FilmProgress | None = None


def film(services: Services) -> FilmPart:
    """Make the part that writes a video. Raises RobotError if nothing can be drawn."""
    wanted: FilmPlan = services.plan.options["film"]
    story = services.plan.story
    title = story.title if story else services.project.name
    robot = services.setup.robot
    return FilmPart(
        wanted.path, robot, services.narrator, wanted.track, size=wanted.size, title=title, progress=wanted.progress
    )


def console(services: Services) -> ConsolePart:
    """Make the part that serves the console's pages in a process of its own."""
    directory = directory_of(services)
    root = directory.root if directory else Path(services.project.root)
    return ConsolePart(root, services.plan.url, services.tell("console"))
