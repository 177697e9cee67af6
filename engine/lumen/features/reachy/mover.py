"""Computes the next target of Reachy Mini's joints from commands, aims and lifelike movements."""

from collections.abc import Collection, Mapping

from lumen.features.reachy.following import limited, possible
from lumen.features.reachy.pose import JOINTS
from lumen.language.robots import Body

SENT_TOLERANCE = 1e-5
"""Targets that differ by less than this [rad, m] are not sent, because the daemon keeps the last target."""


class Mover:
    """The goals of Reachy Mini's joints.

    `goal` has each joint's position by commands and aims, and `sent` the last target for the robot [rad, m]. Targets
    are sent only while the robot is `awake`.
    """

    def __init__(self, body: Body) -> None:
        self.body = body
        self.goal: dict[str, float] = {name: body.postures["Stand"].get(name, 0.0) for name in JOINTS}
        self.sent: dict[str, float] = dict(self.goal)
        self.awake = False
        self._aims: dict[str, tuple[float, float]] = {}

    def stand(self, joints: Mapping[str, float]) -> None:
        """Drop all aims, and continue from these measured joints [rad, m]."""
        self.goal, self.sent = dict(joints), dict(joints)
        self._aims.clear()

    def aim(self, angles: Mapping[str, float], speed: float) -> None:
        """Aim joints at `angles` [rad, m], at a fraction `speed` of their maximum speeds; ignore unknown joints."""
        self._aims |= {name: (angle, speed) for name, angle in angles.items() if name in self.goal}

    def drop_aims(self, joints: Collection[str]) -> None:
        """Drop the aims of these joints, because a command owns them now."""
        for name in joints:
            self._aims.pop(name, None)

    def target(self, offsets: Mapping[str, float], dt: float) -> dict[str, float] | None:
        """Return the next target, `dt` [s] after the last; None if it differs by less than SENT_TOLERANCE.

        `offsets` [rad, m] are those of lifelike movements. No joint exceeds its limits or its maximum speed.
        """
        for name, (angle, speed) in list(self._aims.items()):
            most = speed * self.body.joints[name].speed * dt
            way = angle - self.goal[name]
            self.goal[name] += min(max(way, -most), most)
            if abs(way) <= most:
                del self._aims[name]
        wanted = {name: angle + offsets.get(name, 0.0) for name, angle in self.goal.items()}
        target = limited(possible(wanted, self.body), self.sent, self.body, dt)
        if all(abs(target[name] - self.sent[name]) < SENT_TOLERANCE for name in JOINTS):
            return None
        self.sent = target
        return target
