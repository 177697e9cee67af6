"""Where the feet of a walk stand, as encoders and gyrometer tell."""

from collections.abc import Mapping
from math import atan2

import numpy as np

from lumen.motion.gait.footsteps import Feet
from lumen.motion.gait.legs import SIDES, LegGeometry, Side, other
from lumen.motion.gait.poses import Pose, wrap


class StepTracker:
    """Follows the bearing foot from step to step.

    Each foot has moved as the legs say while both are on the ground: one that comes down still slides a little then.
    Where it points says the gyrometer, counted from `feet` and `heading` [rad] at the beginning: soles turn on the
    floor, which no encoder feels, little in each step and degrees in a hundred. `measured` are the legs' angles.
    """

    def __init__(self, legs: LegGeometry, feet: Feet, measured: Mapping[str, float], heading: float) -> None:
        self._legs, self._seen = legs, list[Pose]()
        left, right = (wrap(feet[side].theta - self._yaw(side, measured)) for side in SIDES)
        self._north = heading - left - wrap(right - left) / 2

    def look(self, next_side: Side, measured: Mapping[str, float]) -> None:
        """Both feet are on the ground; `next_side` leaves it next."""
        self._seen.append(self._legs.foot_from(next_side, measured))

    def stands(self, bearing: Side, feet: Feet, measured: Mapping[str, float], heading: float) -> Pose:
        """Where the bearing foot of a step that ends now has stood; `feet` as believed when it began."""
        place = feet[bearing].place
        if self._seen:
            x, y, _ = np.mean(self._seen, axis=0).tolist()
            place = feet[other(bearing)].then(Pose(x, y)).place
        self._seen.clear()
        return Pose(place.real, place.imag, heading - self._north + self._yaw(bearing, measured))

    def _yaw(self, side: Side, measured: Mapping[str, float]) -> float:
        """Where that foot points, seen from the torso [rad]."""
        turned, _ = self._legs.sole(side, measured)
        return atan2(turned[1, 0], turned[0, 0])
