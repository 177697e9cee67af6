"""Where the robot believes its feet to be, from where it began: by its encoders, never by looking."""

from collections.abc import Iterable, Mapping

from lumen.errors import RobotError
from lumen.interpreters.gait import Feet, Pose, Step, corners, foot_from, middle
from lumen.language.projects import Stage

_FEET = {"L": "left", "R": "right"}


class Whereabouts:
    """Both soles in the frame of the robot's start. `stage`, in the same frame, bounds where they may go."""

    def __init__(self, stage: Stage | None) -> None:
        self._stage = stage
        self._here = Pose()
        self.feet: Feet = {"L": Pose(), "R": Pose()}

    def feel(self, angles: Mapping[str, float]) -> Feet:
        """Both feet, standing as the legs' angles [rad] say; the point between them is where it was."""
        seen: Feet = {"L": Pose(), "R": foot_from("L", angles)}
        between = middle(seen)
        self.feet = {side: self._here.then(foot.seen_from(between)) for side, foot in seen.items()}
        return self.feet

    def land(self, feet: Feet) -> None:
        """Believe that the feet stand there."""
        self.feet, self._here = feet, middle(feet)

    def check(self, steps: Iterable[Step], drift: float = 0.0) -> None:
        """Raises RobotError for a step farther beyond the stage than `drift` [m], or than the feet stand already."""
        if self._stage is None:
            return
        stand = [corner for side, pose in self.feet.items() for corner in corners(Step(side, pose))]
        for step in steps:
            reached = corners(step)
            for axis, (low, high), before, after in (
                ("x", self._stage.x, [p.real for p in stand], [p.real for p in reached]),
                ("y", self._stage.y, [p.imag for p in stand], [p.imag for p in reached]),
            ):
                if min(after) < min(low, *before) - drift or max(after) > max(high, *before) + drift:
                    farthest = min(after) if min(after) < low else max(after)
                    raise RobotError(
                        f"the {_FEET[step.side]} foot would leave the stage: "
                        f"it would reach {axis} = {farthest:.2f} m, and the stage is {low:g} to {high:g} m"
                    )
