"""A film of a simulated robot."""

from collections.abc import Sequence
from pathlib import Path

from lumen.app.parts.part import Part
from lumen.errors import UsageError
from lumen.language.events import Event
from lumen.ports import Robot


class FilmPart(Part):
    """Writes each tick into a file. Raises RobotError where nothing can be drawn, UsageError for another robot."""

    def __init__(self, path: Path, robot: Robot) -> None:
        from lumen.robots.simulation import SimulatedRobot
        from lumen.robots.simulation.film import Film

        if not isinstance(robot, SimulatedRobot):
            raise UsageError("a film is one of the simulated robot")
        self._film = Film(path, robot)

    def tick(self, now: float, changes: Sequence[Event]) -> None:
        self._film.tick(now)

    def close(self) -> None:
        self._film.close()
