"""A real NAO, reached through NAOqi. `qi` is imported when a robot is connected to, and not before."""

from lumen.errors import UsageError
from lumen.features.naoqi.robot import NaoqiRobot
from lumen.language.stories import Visitor


class PhysicalHall:
    """A `Hall` in which visitors are real: whoever types speaks, and is seen only where a visual module sees them."""

    def place(self, visitor: Visitor | None) -> None:
        """They stand wherever they stand."""

    def face(self) -> tuple[float, float] | None:
        """The visual module says so, and not the hall."""
        return None

    def touch(self, sensor: str, pressed: bool) -> None:
        raise UsageError(f"touch `{sensor}` of a real robot by hand")

    def sound(self) -> None:
        """Whoever types is not heard."""

    def plug(self, plugged: bool) -> None:
        raise UsageError("plug in a real robot by hand")


__all__ = ["NaoqiRobot", "PhysicalHall"]
