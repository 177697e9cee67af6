"""A robot that a user wrote, given only commands that its body can perform."""

from collections.abc import Callable, Sequence
from functools import partial
from time import monotonic
from typing import TypeVar

from lumen.errors import BadCommandError, LumenError
from lumen.language.commands import Do, Posture, Rest, Stop, Wake
from lumen.language.events import Event
from lumen.language.robots import Body
from lumen.ports import Aim, Idles, Joints, Perform, PerformsVerbs, Robot, RobotCommand, Sense
from lumen.robot.checked_robot import CheckedRobot, of_own_robot
from lumen.robot.command_bounds import CommandBounds
from lumen.robot.command_table import parts_of
from lumen.robot.executor import Executor
from lumen.robot.joint_ways import begun_from
from lumen.robot.skill_runner import SkillRunner

SHADOW = ""
"""The id of the wrapped robot's commands in the executor of features' verbs: these end verbs, or let them begin."""

Ability = TypeVar("Ability")


class BoundedRobot(CheckedRobot):
    """Passes commands to `robot` within the limits and speeds of `body`; refuses those that `body` can't perform.

    If the robot senses its joints, a motion is delayed until the joints can reach the first key in time. Verbs of
    features are performed here unless the robot performs verbs itself (`PerformsVerbs`): they wait for each other's
    parts of the body, but not for parts that the wrapped robot moves. Rests and stops end them.
    """

    def __init__(self, robot: Robot, body: Body, fault: Callable[[str], LumenError] = of_own_robot) -> None:
        super().__init__(robot, fault)
        self._body = body
        self._bounds = CommandBounds(body)
        self._refusals: list[Event] = []
        self._runner = SkillRunner()
        self._skills = Executor(lambda _command, _now: _Nothing(), partial(parts_of, body=body), self._runner.begin)

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
            self._pass_on(id, fit)

    def cancel(self, id: str) -> None:
        self._skills.cancel(id)
        self.robot.cancel(id)

    def poll(self) -> Sequence[Event]:
        refusals, self._refusals = self._refusals, []
        ends = self._skills.advance(monotonic())
        own = [end._replace(at=0.0) for end in ends if end.name.partition(".command.")[2] != SHADOW]
        return [*refusals, *own, *super().poll()]

    def begun(self) -> Sequence[str]:
        return [*(id for id in self._skills.begun() if id != SHADOW), *super().begun()]

    @property
    def busy(self) -> bool:
        """Whether a verb of a feature is under way here."""
        return self._skills.busy

    def close(self) -> None:
        self._runner.close()
        super().close()

    def _pass_on(self, id: str, command: RobotCommand) -> None:
        if isinstance(command, Do) and not isinstance(self.robot, PerformsVerbs):
            self._skills.start(id, command)
            return
        if isinstance(command, Rest | Stop | Wake | Posture):
            self._skills.start(SHADOW, command)
        self.robot.start(id, command)

    def _angles(self) -> dict[str, float]:
        """Return the present angles [rad] of the body's joints; empty if the robot does not sense them."""
        joints = self.read(Sense.JOINT)
        if not isinstance(joints, Joints):
            return {}
        return {name: a for name, a in zip(joints.names, joints.angles, strict=True) if name in self._body.joints}


def ability(robot: Robot, kind: type[Ability]) -> Ability | None:
    """Return the robot, or the robot that it wraps, if it has the ability `kind`; else None."""
    own = robot.robot if isinstance(robot, CheckedRobot) else robot
    return own if isinstance(own, kind) else None


def is_idle(robot: Robot) -> bool:
    """Return True if the robot reports that it is idle (`Idles`) and performs no verb of a feature."""
    own = ability(robot, Idles)
    return own is not None and own.idle and not (isinstance(robot, BoundedRobot) and robot.busy)


class _Nothing:
    """The activity of a `SHADOW` command, which the wrapped robot performs: it ends at once."""

    def advance(self, now: float) -> bool:
        return True

    def cancel(self) -> None:
        """Do nothing, because the activity ends at once."""
