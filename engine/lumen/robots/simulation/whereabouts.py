"""Where the robot believes its feet to be, from where it began: by its encoders, never by looking."""

from collections.abc import Iterable, Mapping

from lumen.errors import RobotError
from lumen.interpreters.gait import Feet, Pose, Step, corners, foot_from, middle
from lumen.language.projects import Stage

_FEET = {"L": "left", "R": "right"}


ASTRAY = 0.3
"""How far the robot may have moved while it was down [m]: sitting, lying and getting up shift it by 0.1 to 0.3 m."""


class Whereabouts:
    """Both soles in the frame of the robot's start. `stage`, in the same frame, bounds where they may go.

    `doubt` is how far from there the robot may really be [m]: nothing tells it how it slid while it was down.
    """

    def __init__(self, stage: Stage | None) -> None:
        self._stage = stage
        self._down = False
        self.doubt = 0.0
        self._here = Pose()
        self.feet: Feet = {"L": Pose(), "R": Pose()}

    def lose(self) -> None:
        """The robot is down, or falls: from now on it is in doubt where it is."""
        if not self._down:
            self._down, self.doubt = True, self.doubt + ASTRAY

    def feel(self, angles: Mapping[str, float]) -> Feet:
        """Both feet, standing as the legs' angles [rad] say; the point between them is where it was."""
        seen: Feet = {"L": Pose(), "R": foot_from("L", angles)}
        between = middle(seen)
        self._down = False
        self.feet = {side: self._here.then(foot.seen_from(between)) for side, foot in seen.items()}
        return self.feet

    def land(self, feet: Feet) -> None:
        """Believe that the feet stand there."""
        self.feet, self._here = feet, middle(feet)

    def check(self, steps: Iterable[Step], drift: float = 0.0) -> None:
        """Raises RobotError for a step farther beyond the stage than `drift` [m], or than the feet stand already.

        In doubt, the stage is that much smaller on every side: wherever the robot really is, it stays on it. A stage
        with no room left for that keeps the robot where it is.
        """
        if self._stage is None:
            return
        stand = [corner for side, pose in self.feet.items() for corner in corners(Step(side, pose))]
        for step in steps:
            reached = corners(step)
            for axis, (low, high), before, after in (
                ("x", self._stage.x, [p.real for p in stand], [p.real for p in reached]),
                ("y", self._stage.y, [p.imag for p in stand], [p.imag for p in reached]),
            ):
                least, most = low + self.doubt, high - self.doubt
                if min(after) < min(least, *before) - drift or max(after) > max(most, *before) + drift:
                    farthest = min(after) if min(after) < least else max(after)
                    raise RobotError(
                        f"the {_FEET[step.side]} foot {'might' if self.doubt else 'would'} leave the stage: "
                        f"it would reach {axis} = {farthest:.2f} m, and the stage is {low:g} to {high:g} m{self._but()}"
                    )

    def _but(self) -> str:
        return f"; the robot has been down since, and may be {self.doubt:g} m off" if self.doubt else ""
