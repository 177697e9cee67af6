"""Posture changes along paths on which the robot does not fall, down to the floor and up again."""

from collections.abc import Callable, Collection
from dataclasses import dataclass
from math import cos, pi
from typing import Protocol

from lumen.errors import RobotFailedError, RobotRefusedError
from lumen.features.simulation.joint_transition import JointTransition, duration
from lumen.features.simulation.motors import Motors
from lumen.language.motions import MotionDefinition
from lumen.language.robots import Body
from lumen.motion.postures import lies, passage, route
from lumen.motion.trajectories import Trajectory

MAX_ATTEMPTS = 3
"""The maximum number of attempts if the robot ends on the floor."""

LYING_TILT = pi / 3
"""The torso's tilt beyond which the robot is lying [rad]; a relaxed, sitting robot tilts half as much."""

SETTLING_TIME, REST_TIME = 1.5, 0.4
"""The time to bring a lying or sitting robot's joints to its posture, and the pause after a passage [s]."""


class UprightSensor(Protocol):
    """A sensor of the upward direction `up` in the torso's axes (forward, left, up)."""

    @property
    def up(self) -> tuple[float, float, float]: ...


@dataclass
class PostureState:
    """The robot's posture, or the passage between two postures at which it stopped."""

    posture: str
    """The robot's present posture, or the posture that it left last."""
    standing: Collection[str]
    """The postures in which the robot stands, on both feet if it has them."""
    passage: MotionDefinition | None = None
    """The interrupted passage; None if the robot is in a posture."""
    reached: float = 0.0
    """The time reached in the interrupted passage [s]."""

    @property
    def upright(self) -> bool:
        """True if the robot is in a standing posture, and not in an interrupted passage."""
        return self.posture in self.standing and self.passage is None


def lying(feeling: UprightSensor) -> str:
    """Return `LyingBack` or `LyingBelly` if the robot's torso is lying, else an empty text."""
    forward, _, up = feeling.up
    if up > cos(LYING_TILT):
        return ""
    return "LyingBack" if forward > 0 else "LyingBelly"


class PosturePlanner:
    """A route to the nearest of the postures `goals`, passage by passage, with a check of each result.

    A robot that ends on the floor begins again from there, with at most `MAX_ATTEMPTS` attempts. If cancelled, the
    robot halts, and the next route continues from there. `speed` is a share of the maximum. `settle` first brings the
    joints to the present posture, for a robot whose joints can be at any angles. `after` is called at the end. Raises
    RobotError if no route leads to a goal.
    """

    def __init__(
        self,
        motors: Motors,
        body: Body,
        feeling: UprightSensor,
        state: PostureState,
        goals: tuple[str, ...],
        now: float,
        *,
        speed: float = 1.0,
        settle: bool = False,
        after: Callable[[], None] | None = None,
    ) -> None:
        self._motors, self._body, self._feeling, self._posture_state = motors, body, feeling, state
        self._goals, self._speed, self._after = goals, speed, after
        self._left = MAX_ATTEMPTS
        self._cancelled = False
        self._step = self._settled(now) if settle else self._next(now)

    @property
    def passing(self) -> bool:
        """True if the robot is on a passage between two postures."""
        return isinstance(self._step, _Passing)

    def advance(self, now: float) -> bool:
        """Continue the route for `now` [s]; return True at its end, or at rest after `cancel`.

        Raises RobotFailedError if the robot did not reach a posture and does not try again, RobotRefusedError if no
        route leads to a goal from where it lies.
        """
        if self._step is not None and not self._step.advance(now):
            return False
        if self._cancelled:
            self._step = None
            return True
        if self._step is not None:
            self._step = self._next(now) if self._arrived() else self._settled(now)
        if self._step is None and self._after:
            self._after()
        return self._step is None

    def cancel(self) -> None:
        """Halt; in a passage, record the time reached, from which the next route continues."""
        if isinstance(self._step, _Passing):
            self._posture_state.passage, self._posture_state.reached = self._step.motion, self._step.reached
            self._step = None
        elif self._step is not None:
            self._step.cancel()
        self._cancelled = True

    def _arrived(self) -> bool:
        """Record the posture reached; return True if it is the intended one.

        Raises RobotFailedError after the last attempt, or if the robot neither reached the posture nor is lying.
        """
        step, state = self._step, self._posture_state
        state.posture, state.passage = step.end if step else state.posture, None
        down = lying(self._feeling)
        if down == (state.posture if lies(state.posture) else ""):
            return True
        self._left -= 1
        if not self._left or not down:
            raise RobotFailedError(f"the robot did not reach {state.posture}" + (": it lies" if down else ""))
        state.posture = down
        return False

    def _next(self, now: float) -> "_Passing | _Straight | None":
        state = self._posture_state
        if state.passage:
            return _Passing(self._motors, state.passage, now, state.reached)
        path = route(self._body, state.posture, *self._goals)
        if path is None:
            raise RobotRefusedError(f"there is no way from {state.posture} to {' or '.join(self._goals)}")
        if not path:
            return None
        motion = passage(self._body, state.posture, path[0])
        if motion:
            return _Passing(self._motors, motion, now)
        return _Straight(self._motors, self._body, path[0], now, duration(self._speed))

    def _settled(self, now: float) -> "_Straight":
        return _Straight(self._motors, self._body, self._posture_state.posture, now, SETTLING_TIME)


class _Straight:
    """Moves all joints together to a posture."""

    def __init__(self, motors: Motors, body: Body, end: str, now: float, seconds: float) -> None:
        self.end = end
        self._transition = JointTransition(motors, body.postures[end], now, seconds)

    def advance(self, now: float) -> bool:
        """Set the joints' goals for `now` [s]; return True at the posture, or at rest after `cancel`."""
        return self._transition.advance(now)

    def cancel(self) -> None:
        """Begin to slow down."""
        self._transition.cancel()


class _Passing:
    """Moves along a passage from the time `reached` [s], then pauses for REST_TIME."""

    def __init__(self, motors: Motors, motion: MotionDefinition, now: float, reached: float = 0.0) -> None:
        self.motion, self.end, self.reached = motion, motion.end, reached
        self._motors, self._begin = motors, now - reached
        self._trajectory = Trajectory(motion, motors.wanted(motion.tracks) if not reached else None)

    def advance(self, now: float) -> bool:
        """Set the joints' goals on the passage for `now` [s]; return True once REST_TIME has passed since its end."""
        self.reached = min(now - self._begin, self.motion.duration)
        self._motors.aim(self._trajectory.sample(self.reached))
        return now - self._begin >= self.motion.duration + REST_TIME
