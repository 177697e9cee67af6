"""A robot that a user wrote, given only commands that its body can perform."""

from collections.abc import Sequence
from typing import TypeVar

from lumen.errors import BadCommandError
from lumen.language.events import Event
from lumen.language.robots import Body
from lumen.ports import Aim, Joints, Perform, Reading, Robot, RobotCommand, Sense
from lumen.robots.command_bounds import CommandBounds
from lumen.robots.joint_ways import begun_from

Ability = TypeVar("Ability")


class BoundedRobot:
    """Passes commands to `robot` within the limits and speeds of `body`, and refuses those that it can't perform.

    If the robot senses its joints, a motion is delayed until they can reach its first key in time.
    """

    def __init__(self, robot: Robot, body: Body) -> None:
        self.robot, self._body = robot, body
        self._bounds = CommandBounds(body)
        self._refusals: list[Event] = []

    def start(self, id: str, command: RobotCommand) -> None:
        if isinstance(command, Aim):
            if aim := self._bounds.aim(command, self._angles()):
                self.robot.start(id, aim)
            return
        try:
            fit = self._bounds.fit(command)
            if isinstance(fit, Perform):
                fit = Perform(begun_from(fit.motion, self._body, self._angles()))
        except BadCommandError as error:
            self._refusals.append(Event(f"error.command.{id}", {"reason": str(error)}))
        else:
            self.robot.start(id, fit)

    def cancel(self, id: str) -> None:
        self.robot.cancel(id)

    def poll(self) -> Sequence[Event]:
        refusals, self._refusals = self._refusals, []
        return [*refusals, *self.robot.poll()]

    def begun(self) -> Sequence[str]:
        return self.robot.begun()

    def read(self, sense: Sense) -> Reading | None:
        return self.robot.read(sense)

    def close(self) -> None:
        self.robot.close()

    def _angles(self) -> dict[str, float]:
        """The present angles [rad] of the body's joints; empty if the robot does not sense them."""
        joints = self.robot.read(Sense.JOINT)
        if not isinstance(joints, Joints):
            return {}
        return {name: a for name, a in zip(joints.names, joints.angles, strict=True) if name in self._body.joints}


def ability(robot: Robot, kind: type[Ability]) -> Ability | None:
    """Return the robot, or the one that it wraps, as one with that ability; None if it lacks it."""
    own = robot.robot if isinstance(robot, BoundedRobot) else robot
    return own if isinstance(own, kind) else None
