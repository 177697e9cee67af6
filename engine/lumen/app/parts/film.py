"""A film of a simulated robot."""

from collections.abc import Sequence
from pathlib import Path

from lumen.app.film_sound import add_sound
from lumen.app.parts.part import Part
from lumen.errors import UsageError
from lumen.language.events import Event
from lumen.modules.audio_track import AudioTrack
from lumen.ports import Robot


class FilmPart(Part):
    """Writes each tick into a file, and when it is closed what `track` heard.

    Raises RobotError where nothing can be drawn, UsageError for another robot.
    """

    def __init__(self, path: Path, robot: Robot, track: AudioTrack | None = None) -> None:
        from lumen.robots.simulation import SimulatedRobot
        from lumen.robots.simulation.film import Film

        if not isinstance(robot, SimulatedRobot):
            raise UsageError("a film is one of the simulated robot")
        self._film, self._path, self._track = Film(path, robot), path, track

    def tick(self, now: float, changes: Sequence[Event]) -> None:
        self._film.tick(now)

    def close(self) -> None:
        self._film.close()
        if self._track:
            add_sound(self._path, self._track, self._film.length)
            self._track = None
