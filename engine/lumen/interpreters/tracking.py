"""A head that follows what is seen, and looks for what it has lost.

Each sight moves the joints to where they stood *when the image was taken* plus the controller's output times the
binding's gain. Adding the output to the angles last commanded instead overshoots as soon as camera and bus take time:
the same error is then corrected again and again before its correction can be seen.
"""

from bisect import bisect_left
from collections import deque
from collections.abc import Mapping
from math import inf, isfinite, pi, sin
from typing import Any

from lumen.errors import LumenError
from lumen.interpreters.glance import Glance
from lumen.interpreters.limits import coupled_range
from lumen.language.controllers import Controller
from lumen.language.robots import Body

Angles = dict[str, float]

SWING = 0.5235987755982988
"""How far the first joint swings to either side in search where the file does not say: 30 deg, in [rad]."""

EARLY = 0.1
"""How far in the future [s] a message may say it was made, as clocks go; farther, it goes by another clock."""


class Tracker:
    """What a bound controller asks of its joints. It reads no clock and moves nothing; times are in [s].

    Tell it the joints' measured angles (`pose`) and what was seen (`see`); where nothing was seen, ask it what to do
    (`idle`). `routes` are those whose messages it wants, `joints` those that it moves.
    """

    def __init__(self, controller: Controller, body: Body) -> None:
        self.controller = controller
        self.routes = frozenset(binding.route for binding in controller.input_bindings)
        self.joints = tuple(dict.fromkeys(b.joint for b in controller.output_bindings if b.joint in body.joints))
        self._body = body
        self._bindings = [b for b in controller.output_bindings if b.joint in body.joints]
        self._glance = Glance(controller, body)
        self._inputs: dict[str, float] = {}
        self._turn: Angles = {}
        self._poses: deque[tuple[float, Angles]] = deque()
        self._seen = -inf
        self._lost_since: float | None = None
        self._held: Angles = {}

    def succeed(self, before: "Tracker") -> None:
        """Go on where another one stood that moved the same joints: with the poses it knew, and what it saw last."""
        if set(self.joints) <= set(before.joints):
            self._poses.extend((time, {j: angles[j] for j in self.joints}) for time, angles in before._poses)
            self._seen, self._lost_since = before._seen, before._lost_since
            self._held = {joint: before._held[joint] for joint in self.joints if joint in before._held}

    def pose(self, time: float, angles: Mapping[str, float], *, now: float = inf) -> None:
        """Remember where the joints stand [rad], measured at `time`, as a message says that comes in at `now`.

        It is no pose where one of `joints` is missing, where something is no number, or where it lies in the future:
        more than `EARLY` after `now`.
        """
        measured = _number(time)
        turned = {joint: angle for joint in self.joints if (angle := _number(angles.get(joint))) is not None}
        if measured is None or measured > now + EARLY or len(turned) < len(self.joints):
            return
        if self._poses and measured <= self._poses[-1][0]:
            return
        self._poses.append((measured, turned))
        while self._poses[0][0] < measured - 2.0 * self.controller.tracking.stale:
            self._poses.popleft()

    def see(
        self, fields: Mapping[str, Any], captured_at: float, route: str | None = None, *, now: float = inf
    ) -> Angles | None:
        """Where the joints should go [rad], from the body of a message and when its image was taken.

        `route` is the message's, for a controller whose inputs come from several; `now` is when it came in. None where
        the sight is stale, older than the one before, from the future (`EARLY`), lacks a field, comes before the first
        pose, or fires no rule of an output without default.
        """
        captured = _number(captured_at)
        if captured is None or captured > now + EARLY or captured < self._seen or not self._poses:
            return None
        if self._poses[-1][0] - captured > self.controller.tracking.stale or not self._take(fields, route):
            return None
        pose = self.pose_at(captured)
        try:
            self._turn = self._glance.turn(self._inputs, pose)
        except LumenError:
            return None
        target = self.clamped({joint: angle + self._turn[joint] for joint, angle in pose.items()})
        self._seen, self._lost_since, self._held = captured, None, target
        return target

    def idle(self, now: float) -> Angles | None:
        """Where the joints should go [rad] while nothing is seen: None to stay, then a search, then ahead."""
        times = self.controller.tracking
        if not self._poses:
            return None
        if self._lost_since is None:
            self._lost_since = self._seen if isfinite(self._seen) else now
            self._held = self._held or self.pose_at(now)
        gone = now - self._lost_since - times.hold
        if gone < 0.0:
            return None
        if gone < times.search:
            swing = sin(2.0 * pi * gone / times.period)
            return self.clamped({j: a + swing * self._sweep(j) for j, a in self._held.items()})
        return self.clamped({joint: times.ahead.get(joint, 0.0) for joint in self.joints})

    def pose_at(self, time: float) -> Angles:
        """Where the joints stood at a time, between the poses remembered; the nearest one outside them."""
        poses = self._poses
        i = bisect_left(poses, time, key=lambda pose: pose[0])
        if i == 0 or i == len(poses):
            return dict(poses[min(i, len(poses) - 1)][1])
        (t0, before), (t1, after) = poses[i - 1], poses[i]
        w = (time - t0) / (t1 - t0)
        return {joint: angle + w * (after[joint] - angle) for joint, angle in before.items()}

    def clamped(self, angles: Mapping[str, float]) -> Angles:
        """The nearest angles within the bindings', the joints' and the coupled limits [rad]."""
        result = dict(angles)
        for joint, angle in angles.items():
            low, high = self._limits(joint)
            result[joint] = min(max(angle, low), high)
        for limit in self._body.coupled:
            if limit.joint in result:
                low, high = coupled_range(limit, result.get(limit.on, 0.0))
                result[limit.joint] = min(max(result[limit.joint], low), high)
        return result

    def _limits(self, joint: str) -> tuple[float, float]:
        low, high = self._body.joints[joint].minimum, self._body.joints[joint].maximum
        for binding in self._bindings:
            if binding.joint == joint:
                low = low if binding.minimum is None else max(low, binding.minimum)
                high = high if binding.maximum is None else min(high, binding.maximum)
        return low, high

    def _sweep(self, joint: str) -> float:
        """How far the joint swings, to the side first on which the face was seen last."""
        sweep = self.controller.tracking.sweep
        far = sweep.get(joint, 0.0) if sweep else SWING * (joint == self.joints[0])
        return -far if self._turn.get(joint, 0.0) < 0.0 else far

    def _take(self, fields: Mapping[str, Any], route: str | None) -> bool:
        """Read the inputs' fields; true where every input has a value by now."""
        for binding in self.controller.input_bindings:
            if route in (None, binding.route):
                value: Any = fields
                for step in binding.path:
                    value = value.get(step) if isinstance(value, Mapping) else None
                if (number := _number(value)) is None:
                    return False
                self._inputs[binding.variable] = number
        return self._inputs.keys() == self.controller.inputs.keys()


def _number(value: object) -> float | None:
    """A finite number from somebody's message; None for anything else, and for an integer beyond all floats."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    try:
        number = float(value)
    except OverflowError:
        return None
    return number if isfinite(number) else None
