"""A body's joint limits, which no command can exceed."""

import numpy as np
from numpy.typing import NDArray

from lumen.language.robots import Body
from lumen.motion.limits import coupled_range

JointVector = NDArray[np.float64]
"""A value for each joint in the order of `body.joints`, Shape (joints,) [rad; slides m; hands 0..1]."""


class JointEnvelope:
    """One body's joint limits, coupled limits, maximum speeds and shared motors."""

    def __init__(self, body: Body) -> None:
        names = list(body.joints)
        joints = body.joints.values()
        self.low = np.array([j.minimum for j in joints])
        self.high = np.array([j.maximum for j in joints])
        self.speed = np.array([j.speed for j in joints])
        self._shared = [(names.index(follower), names.index(leader)) for follower, leader in body.shared.items()]
        self._coupled = [(names.index(c.joint), names.index(c.on), c) for c in body.coupled]

    def step(self, last: JointVector, goal: JointVector, dt: float) -> JointVector:
        """Return the joint angles to command `dt` [s] after `last` on the way to `goal`.

        Every joint stays within its limits and its maximum speed, for any goal. If a joint can't follow a coupled
        limit in time, the joint that narrows the limit slows down or waits.
        """
        reach = self.speed * dt
        result: JointVector = np.maximum(np.minimum(goal, last + reach), last - reach)
        np.minimum(np.maximum(result, self.low, out=result), self.high, out=result)
        for joint, on, limit in self._coupled:
            before, held, most = last.item(on), last.item(joint), reach.item(joint)
            way, wanted = result.item(on) - before, result.item(joint)
            for share in (1.0, 0.5, 0.25, 0.0):
                low, high = coupled_range(limit, before + share * way)
                inside = min(max(wanted, low), high)
                if share == 0.0 or abs(inside - held) <= most:
                    break
            result[on] = before + share * way
            result[joint] = min(max(inside, held - most), held + most)
        for follower, leader in self._shared:
            result[follower] = result[leader]
        return result
