"""Where the robot may go: its stage, by its own odometry, and what must not be in its way."""

from collections.abc import Callable, Mapping, Sequence
from math import cos, hypot, sin

from lumen.errors import RobotRefusedError
from lumen.features.naoqi.hardware import Hardware
from lumen.language.projects import Stage
from lumen.motion.dead_reckoning import DeadReckoning, turned
from lumen.ports import Sonar, Whereabouts
from lumen.robot.hazards import danger

FALL_DRIFT = 0.6
"""How far the robot may have slid while it fell and got up again [m], as the simulated one does."""
MOST_BETWEEN_LOOKS = 0.5
"""A robot that has come farther than this between two looks did not walk there: its odometry began anew [m]."""
MAX_STAGE_DRIFT = 0.03
"""By how much the way to a place may leave the stage [m]."""

GroundPose = Sequence[float]
"""x, y [m] and theta [rad] as `ALMotion.getRobotPosition` has them."""


class WalkingArea:
    """Knows where the robot was when it was met first, which is the origin of the stage.

    `pressed` says which sensors are touched, `echo` what the sonars hear now, None where they are silent;
    `hardware` how far the robot reaches.
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
        """The robot stands there; the first time counts."""
        self._origin = self._origin or place

    def whereabouts(self, place: GroundPose) -> Whereabouts:
        """Where the robot is on the stage, which stands there now; it is asked often, and adds up the doubt."""
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
        """The robot has fallen: nothing measures how far it slides until it stands again."""
        self._reckoning.slid += FALL_DRIFT

    def danger(self) -> str:
        """Why the robot must not walk now; empty where nothing is in the way."""
        echo = self._echo()
        return danger(self._pressed, (d for d in (echo.left, echo.right) if d > 0.0) if echo else ())

    def check_way(self, here: GroundPose, way: GroundPose) -> None:
        """Raises RobotError where a walk by `way` from `here` would leave the stage, farther than the robot has."""
        x, y, theta = here
        ahead = x + way[0] * cos(theta) - way[1] * sin(theta), y + way[0] * sin(theta) + way[1] * cos(theta)
        if reason := self.outside((*ahead, theta), here):
            raise RobotRefusedError(f"{reason}: the robot did not start walking")

    def outside(self, there: GroundPose, before: GroundPose, drift: float = 0.0) -> str:
        """Why it must not be `there`; empty where the stage has room, or it is no farther out than it was `before`."""
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
