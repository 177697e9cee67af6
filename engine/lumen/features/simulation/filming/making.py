"""The film of a run."""

from dataclasses import dataclass
from pathlib import Path

from lumen.features.simulation.filming.part import FilmPart
from lumen.features.simulation.filming.progress import FilmProgress
from lumen.run.audio_track import AudioTrack
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
