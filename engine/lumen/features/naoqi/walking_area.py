"""Keeps the robot's walks on its stage, by odometry, and away from obstacles."""

from collections.abc import Callable, Mapping, Sequence
from math import cos, hypot, sin

from lumen.errors import RobotRefusedError
from lumen.features.naoqi.hardware import Hardware
from lumen.language.projects import Stage
from lumen.motion.wayfinding import DeadReckoning, turned
from lumen.ports import Sonar, Whereabouts
from lumen.robot.hazards import danger

FALL_DRIFT = 0.6
"""The distance that the robot may have slid in a fall and while getting up [m], as in the simulation."""
MOST_BETWEEN_LOOKS = 0.5
"""The distance between two position readings above which the odometry counts as reset [m]."""
MAX_STAGE_DRIFT = 0.03
"""The maximum distance by which a walking robot may leave the stage [m]."""

GroundPose = Sequence[float]
"""x, y [m] and theta [rad], as from `ALMotion.getRobotPosition`."""


class WalkingArea:
    """Checks walks against the stage, whose origin is the robot's first position, and against obstacles.

    `pressed` has the state of the tactile sensors; `echo` returns the sonars' reading, None if unavailable; `hardware`
    has the robot's reach.
    """

    def __init__(
        self,
        stage: Stage | None,
        pressed: Mapping[str, bool],
        echo: Callable[[], Sonar | None],
        hardware: Hardware,
    ) -> None:
        self.stage, self._edge, self._reach = stage, hardware.edge, hardware.reach
        self._pressed, self._echo = pressed, echo
        self._origin: GroundPose | None = None
        self._reckoning = DeadReckoning()

    def meet(self, place: GroundPose) -> None:
        """Use the robot's position as the stage's origin, unless an origin is set."""
        self._origin = self._origin or place

    def whereabouts(self, place: GroundPose) -> Whereabouts:
        """Return the robot's place on the stage for NAOqi's `place`.

        Call this often, because it also accumulates the uncertainty.
        """
        self.meet(place)
        assert self._origin is not None
        x, y = self._on_stage(place)
        before = self._reckoning.whereabouts
        jump = hypot(x - before.x, y - before.y)
        if jump > MOST_BETWEEN_LOOKS:
            self._reckoning.slid += jump
        self._reckoning.follow(x, y, turned(self._origin[2], place[2]))
        return self._reckoning.whereabouts

    def fell(self) -> None:
        """Increase the uncertainty after a fall, because no sensor measures how far the robot slides."""
        self._reckoning.slid += FALL_DRIFT

    def danger(self) -> str:
        """Return why the robot must not walk now; empty if no obstacle is detected."""
        echo = self._echo()
        return danger(self._pressed, (d for d in (echo.left, echo.right) if d > 0.0) if echo else ())

    def check_way(self, here: GroundPose, way: GroundPose) -> None:
        """Raise RobotRefusedError if a walk by `way` would end outside the stage, and farther out than `here`.

        `way` is relative to `here`: ahead and left [m], and the turn [rad].
        """
        x, y, theta = here
        ahead = x + way[0] * cos(theta) - way[1] * sin(theta), y + way[0] * sin(theta) + way[1] * cos(theta)
        if reason := self.outside((*ahead, theta), here):
            raise RobotRefusedError(f"{reason}: the robot did not start walking")

    def outside(self, there: GroundPose, before: GroundPose, drift: float = 0.0) -> str:
        """Return why the robot must not be `there`; empty on the stage, or if `there` is no farther out than `before`.

        Both limits have a tolerance of `drift` [m]. Without a stage or an origin, return an empty string.
        """
        if self.stage is None or self._origin is None:
            return ""
        reached, stood = self._on_stage(there), self._on_stage(before)
        for axis, (low, high), now, then in (
            ("x", self.stage.x, reached[0], stood[0]),
            ("y", self.stage.y, reached[1], stood[1]),
        ):
            if (
                now - self._reach < min(low, then - self._reach) - drift
                or now + self._reach > max(high, then + self._reach) + drift
            ):
                return f"{self._edge} would leave the stage: the robot would be at {axis} = {now:.2f} m"
        return ""

    def _on_stage(self, place: GroundPose) -> tuple[float, float]:
        assert self._origin is not None
        x0, y0, theta = self._origin
        dx, dy = place[0] - x0, place[1] - y0
        return dx * cos(theta) + dy * sin(theta), dy * cos(theta) - dx * sin(theta)
