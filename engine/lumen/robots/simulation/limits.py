"""What a body allows its joints: the envelope that no command can leave."""

import numpy as np
from numpy.typing import NDArray

from lumen.interpreters.limits import coupled_range
from lumen.language.robots import Body

Angles = NDArray[np.float64]
"""[rad; hands 0..1], Shape (joints,), in the order of `body.joints`."""


class Envelope:
    """Limits, coupled limits, greatest speeds and shared motors of one body."""

    def __init__(self, body: Body) -> None:
        names = list(body.joints)
        joints = body.joints.values()
        self.low = np.array([j.minimum for j in joints])
        self.high = np.array([j.maximum for j in joints])
        self.speed = np.array([j.speed for j in joints])
        self._shared = [(names.index(follower), names.index(leader)) for follower, leader in body.shared.items()]
        self._coupled = [(names.index(c.joint), names.index(c.on), c) for c in body.coupled]

    def step(self, last: Angles, goal: Angles, dt: float) -> Angles:
        """The next command on the way from the last one to `goal`, `dt` [s] later.

        Every joint stays inside its limits and below its greatest speed, whatever the goal is; where a joint can't
        follow a coupled limit in time, the joint that narrows it waits.
        """
        reach = self.speed * dt
        result: Angles = np.clip(last + np.clip(goal - last, -reach, reach), self.low, self.high)
        for joint, on, limit in self._coupled:
            for share in (1.0, 0.5, 0.25, 0.0):
                angle = last[on] + share * (result[on] - last[on])
                low, high = coupled_range(limit, float(angle))
                inside = min(max(float(result[joint]), low), high)
                if share == 0.0 or abs(inside - last[joint]) <= reach[joint]:
                    break
            result[on] = angle
            result[joint] = min(max(inside, last[joint] - reach[joint]), last[joint] + reach[joint])
        for follower, leader in self._shared:
            result[follower] = result[leader]
        return result
