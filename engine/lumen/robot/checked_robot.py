"""A robot that a user wrote: everything that it returns is of the type that `Robot` declares."""

from collections.abc import Callable, Iterable, Sequence
from typing import TypeVar

from lumen.errors import LumenError, RobotError
from lumen.language.events import Event
from lumen.ports import HasOtherSenses, Joints, OtherReading, Reading, Robot, RobotCommand, Sense

Kind = TypeVar("Kind")


def of_own_robot(what: str) -> LumenError:
    """Return the error for a fault of a robot that does not come from a package."""
    return RobotError(f"the robot {what}")


class CheckedRobot:
    """Passes everything on to `robot`, and checks the types of the values that it returns.

    `fault` makes the error that ends the run after a wrong value. It is called with a description such as "returned
    None from `poll`: it must return events".
    """

    def __init__(self, robot: Robot, fault: Callable[[str], LumenError] = of_own_robot) -> None:
        self.robot, self._fault = robot, fault

    def start(self, id: str, command: RobotCommand) -> None:
        self.robot.start(id, command)

    def cancel(self, id: str) -> None:
        self.robot.cancel(id)

    def poll(self) -> Sequence[Event]:
        return self._all("poll", self.robot.poll(), Event, "events")

    def begun(self) -> Sequence[str]:
        return self._all("begun", self.robot.begun(), str, "ids of commands")

    def read(self, sense: Sense) -> Reading | None:
        reading = self.robot.read(sense)
        if not (reading is None or isinstance(reading, Reading)):
            raise self._wrong("read", reading, "a `lumen.ports.Reading` or None")
        if isinstance(reading, Joints) and not len(reading.names) == len(reading.angles) == len(reading.stiffness):
            raise self._wrong("read", reading, "an angle and a stiffness for each name")
        return reading

    def read_other(self, sense: str) -> OtherReading | None:
        reading = self.robot.read_other(sense) if isinstance(self.robot, HasOtherSenses) else None
        if not (reading is None or isinstance(reading, OtherReading)):
            raise self._wrong("read_other", reading, "an object with a `time` or None")
        return reading

    def close(self) -> None:
        self.robot.close()

    def _all(self, method: str, returned: object, kind: type[Kind], what: str) -> Sequence[Kind]:
        if isinstance(returned, Iterable) and not isinstance(returned, str):
            found = list(returned)
            if all(isinstance(each, kind) for each in found):
                return found
            returned = found
        raise self._wrong(method, returned, what)

    def _wrong(self, method: str, returned: object, meant: str) -> LumenError:
        return self._fault(f"returned {returned!r} from `{method}`: it must return {meant}")
