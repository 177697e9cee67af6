"""The robot's estimate of its feet's positions relative to its start, from encoders and the gyrometer's heading."""

from collections.abc import Iterable, Mapping

from lumen.errors import RobotRefusedError
from lumen.language.projects import Stage
from lumen.motion.gait import Feet, Footstep, LegGeometry, Pose, corners, middle
from lumen.motion.gait.poses import wrap
from lumen.motion.postures import lies
from lumen.motion.wayfinding import DeadReckoning
from lumen.ports import Whereabouts

_FEET = {"L": "left", "R": "right"}


DRIFT_AFTER_SITTING, DRIFT_AFTER_LYING_BACK, DRIFT_AFTER_FALL = 0.1, 0.25, 0.6
"""The possible displacement of a robot that stands up [m]: after sitting, after lying on its back, or after a fall.

The last value also applies after lying on its belly. Six robots of various weights on various floors were off by at
most 0.05, 0.13 and 0.47 m.
"""


DRIFT_AFTER_CATCH = 0.1
"""The distance that the feet may have slid during steps that caught a fall [m]."""


class Odometry:
    """The poses of both soles in the frame of the robot's start. `stage`, in this frame, bounds the steps.

    `doubt` is the possible position error [m] from falls, other postures and caught falls, when nothing measures how
    far the robot slides. Only `whereabouts` also includes the growing error of the steps.
    """

    def __init__(self, legs: LegGeometry, stage: Stage | None) -> None:
        self.legs, self._stage = legs, stage
        self._down = False
        self.doubt, self._before = 0.0, 0.0
        self._here, self._heading = Pose(), 0.0
        self._reckoning = DeadReckoning()
        self.feet: Feet = {"L": Pose(), "R": Pose()}

    @property
    def whereabouts(self) -> Whereabouts:
        """The robot's estimated pose and the possible error."""
        return self._reckoning.whereabouts

    def lose(self, posture: str) -> None:
        """Widen the estimate: the robot is in `posture` or leaving it, or has fallen if `posture` is empty."""
        if not self._down:
            self._down, self._before = True, self.doubt
        self.doubt = self._reckoning.slid = max(self.doubt, self._before + drift_after(posture))

    def stumble(self, heading: float) -> None:
        """Turn the feet to this heading [rad] after steps that caught a fall; widen the estimate, as feet may slide."""
        between = middle(self.feet)
        right = Pose(between.x, between.y, heading)
        self.land({side: right.then(foot.seen_from(between)) for side, foot in self.feet.items()})
        self.doubt = self._reckoning.slid = self.doubt + DRIFT_AFTER_CATCH

    def keep(self, heading: float) -> None:
        """Record that the robot stands with this heading by the gyrometer [rad].

        If the robot was down, its turn since then is added to the estimated heading.
        """
        if self._down:
            self._down, (x, y, theta) = False, self._here
            self._believe(Pose(x, y, wrap(theta + heading - self._heading)))
        self._heading = heading

    def feel(self, angles: Mapping[str, float]) -> Feet:
        """Return both feet's poses with the legs at these angles [rad]; the midpoint of the feet stays the same."""
        seen: Feet = {"L": Pose(), "R": self.legs.foot_from("L", angles)}
        between = middle(seen)
        self.feet = {side: self._here.then(foot.seen_from(between)) for side, foot in seen.items()}
        return self.feet

    def pass_by(self, feet: Feet) -> None:
        """Set the estimate to the midpoint between these feet, during a walk."""
        self._believe(middle(feet))

    def land(self, feet: Feet) -> None:
        """Set the estimate to these standing feet."""
        self.feet = feet
        self._believe(middle(feet))

    def _believe(self, here: Pose) -> None:
        self._here = here
        self._reckoning.follow(*here)

    def check(self, steps: Iterable[Footstep], drift: float = 0.0) -> None:
        """Raise RobotError if a step ends more than `drift` [m] beyond both the stage and the feet's present extent.

        The stage counts as smaller by `doubt` on every side, which keeps the robot on it despite the possible error.
        Without a stage, every step is allowed.
        """
        if self._stage is None:
            return
        size = self.legs.sole_size
        stand = [corner for side, pose in self.feet.items() for corner in corners(Footstep(side, pose), size)]
        for step in steps:
            reached = corners(step, size)
            for axis, (low, high), before, after in (
                ("x", self._stage.x, [p.real for p in stand], [p.real for p in reached]),
                ("y", self._stage.y, [p.imag for p in stand], [p.imag for p in reached]),
            ):
                least, most = low + self.doubt, high - self.doubt
                if min(after) < min(least, *before) - drift or max(after) > max(most, *before) + drift:
                    farthest = min(after) if min(after) < least else max(after)
                    raise RobotRefusedError(
                        f"the {_FEET[step.side]} foot {'might' if self.doubt else 'would'} leave the stage: "
                        f"it would reach {axis} = {farthest:.2f} m, but the stage "
                        f"goes from {low:g} to {high:g} m{self._but()}"
                    )

    def _but(self) -> str:
        return f"; the robot has fallen since, so its position may be wrong by {self.doubt:g} m" if self.doubt else ""


def drift_after(posture: str) -> float:
    """Return the possible displacement of a robot that was in `posture` [m]; an empty posture means a fall."""
    if posture == "LyingBack":
        return DRIFT_AFTER_LYING_BACK
    return DRIFT_AFTER_SITTING if posture and not lies(posture) else DRIFT_AFTER_FALL
