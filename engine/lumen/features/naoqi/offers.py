"""A real NAO or Pepper and its hall. `qi` is imported only when a session is created."""

from lumen.errors import UsageError
from lumen.features.naoqi.robot import NaoqiRobot
from lumen.language.stories import Visitor


class PhysicalHall:
    """A `Hall` with real visitors: the operator types words for the robot, and only a visual module sees people."""

    def place(self, visitor: Visitor | None) -> None:
        """Do nothing: real visitors place themselves."""

    def face(self) -> tuple[float, float] | None:
        """Return None: only a visual module sees faces."""
        return None

    def touch(self, sensor: str, pressed: bool) -> None:
        """Raise UsageError, because a real robot is touched by hand."""
        raise UsageError(f"touch `{sensor}` of a real robot by hand")

    def sound(self) -> None:
        """Do nothing: typed words make no sound."""

    def plug(self, plugged: bool) -> None:
        """Raise UsageError, because a real robot is plugged in by hand."""
        raise UsageError("plug in a real robot by hand")


__all__ = ["NaoqiRobot", "PhysicalHall"]
