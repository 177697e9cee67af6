"""A head that follows what the camera sees, and searches for it after it is lost.

Each sight moves the joints to their position *when the image was taken* plus the controller's output times the
binding's gain. Adding the output to the last commanded angles instead overshoots because of the delays of camera and
bus: the same error would be corrected again and again before the correction is visible.

The offsets of the robot's idle life, added to the joints after all commands, are removed from poses and images first: a
follower aims the head that it commands, and idle life moves the head about that aim. Otherwise each look would respond
to a glance, or mistake it for sag.

Weight and friction keep a resting head slightly off its commanded position. The offset is learned while the head rests,
and added; otherwise the head would stop off the face by about that much.
"""

from collections.abc import Mapping
from math import inf, isfinite, pi, sin
from typing import Any

from lumen.errors import LumenError
from lumen.fuzzy.controllers_by_role import by_role
from lumen.language.controllers import ControllerDefinition
from lumen.language.message_numbers import number, number_at
from lumen.language.robots import Body
from lumen.motion.limits import coupled_range
from lumen.motion.visual_servo import JointAngles, JointHistory, VisualServo

SEARCH_SWING = 0.5235987755982988
"""Amplitude of the first joint's search, if the file does not specify one: 30 deg, in [rad]."""

MAX_CLOCK_LEAD = 0.1
"""Accepted lead of a message's time over the local clock [s]; with a greater lead the clocks are different."""

STILL_TIME, STILL_ANGLE = 0.12, 0.006
"""A joint is steady if neither its pose nor its command changed by more than this angle [rad] for this time [s]."""

MAX_SAG = 0.035
"""Greatest offset from the commanded angle due to weight and friction [rad]; a greater offset has another cause."""

SAG_LEARNING_RATE = 0.4
"""Weight of a new measurement of the sag: the head may still be moving."""


class Tracker:
    """Computes joint angles for a bound controller; it reads no clock and moves nothing; times are in [s].

    Pass it the joints' measured angles (`pose`) and what the camera saw (`see`); while nothing is seen, call `idle`.
    `routes` are the routes of the messages that it needs, `joints` those that it moves.
    """

    def __init__(self, controller: ControllerDefinition, body: Body) -> None:
        self.controller = controller = by_role(controller, body)
        self.routes = frozenset(binding.route for binding in controller.input_bindings)
        self.joints = tuple(dict.fromkeys(b.joint for b in controller.output_bindings if b.joint in body.joints))
        self._body = body
        self._bindings = [b for b in controller.output_bindings if b.joint in body.joints]
        self._servo = VisualServo(controller, body)
        self._inputs: dict[str, float] = {}
        self._turn: JointAngles = {}
        self._poses = JointHistory(2.0 * controller.tracking.stale)
        self._commanded = JointHistory(2.0 * controller.tracking.stale)
        self._lived = JointHistory(2.0 * controller.tracking.stale)
        self._seen = -inf
        self._lost_since: float | None = None
        self._held: JointAngles = {}
        self._sag: JointAngles = {}

    def succeed(self, before: "Tracker") -> None:
        """Continue from the state of another tracker of the same joints: its past poses, and its last sight."""
        if set(self.joints) <= set(before.joints):
            pairs = (self._poses, before._poses), (self._commanded, before._commanded), (self._lived, before._lived)
            for mine, theirs in pairs:
                mine.known.extend((time, {j: angles[j] for j in self.joints}) for time, angles in theirs.known)
            self._seen, self._lost_since = before._seen, before._lost_since
            self._held = {joint: before._held[joint] for joint in self.joints if joint in before._held}

    def pose(
        self, time: float, angles: Mapping[str, float], *, now: float = inf, life: Mapping[str, float] | None = None
    ) -> None:
        """Store the joint angles [rad], measured at `time` according to a message that arrived at `now`.

        `life` are the parts of them that idle life has added [rad]; missing or invalid ones count as 0. The pose is
        ignored if one of `joints` is missing, if a value is not a number, or if `time` is more than `MAX_CLOCK_LEAD`
        after `now`.
        """
        measured = number(time)
        turned = {joint: angle for joint in self.joints if (angle := number(angles.get(joint))) is not None}
        if measured is None or measured > now + MAX_CLOCK_LEAD or len(turned) < len(self.joints):
            return
        lived = {joint: number((life or {}).get(joint)) or 0.0 for joint in self.joints}
        self._poses.add(measured, {joint: turned[joint] - lived[joint] for joint in self.joints})
        self._lived.add(measured, lived)

    def see(
        self, fields: Mapping[str, Any], captured_at: float, route: str | None = None, *, now: float = inf
    ) -> JointAngles | None:
        """Return the target angles of the joints [rad], from the body of a message and the time of its image.

        `route` is the message's, for a controller with inputs from several routes; `now` is when it arrived. The
        result is None if the sight is stale, older than the one before, from the future (`MAX_CLOCK_LEAD`) or before
        the first pose, if it lacks a field, or if no rule fires for an output without default.
        """
        captured = number(captured_at)
        if captured is None or captured > now + MAX_CLOCK_LEAD or captured < self._seen or not self._poses:
            return None
        if self._poses.last - captured > self.controller.tracking.stale or not self._take(fields, route):
            return None
        pose = self._poses.at(captured)
        try:
            self._turn = self._servo.turn(self._inputs, pose, self._lived.at(captured))
        except LumenError:
            return None
        target = self.clamped({joint: self._stood(joint, captured) + self._turn[joint] for joint in pose})
        self._seen, self._lost_since, self._held = captured, None, target
        return self._command(target, now if isfinite(now) else self._poses.last)

    def idle(self, now: float) -> JointAngles | None:
        """Return the target angles [rad] while nothing is seen: None to stay, then a search, then straight ahead."""
        times = self.controller.tracking
        if not self._poses:
            return None
        if self._lost_since is None:
            self._lost_since = self._seen if isfinite(self._seen) else now
            self._held = self._held or self._poses.at(now)
        gone = now - self._lost_since - times.hold
        if gone < 0.0:
            return None
        if gone < times.search:
            swing = sin(2.0 * pi * gone / times.period)
            return self._command(self.clamped({j: a + swing * self._sweep(j) for j, a in self._held.items()}), now)
        return self._command(self.clamped({joint: times.ahead.get(joint, 0.0) for joint in self.joints}), now)

    def _stood(self, joint: str, time: float) -> float:
        """Return the reference for a turn [rad]: the joint's pose at `time` plus the joint's sag.

        The sag is learned while the joint and its commands are steady.
        """
        pose, start = self._poses.at(time)[joint], time - STILL_TIME
        sag = self._sag.get(joint, 0.0)
        if self._poses.steady(joint, start, time, STILL_ANGLE) and self._commanded.steady(
            joint, start, time, STILL_ANGLE
        ):
            found = self._commanded.at(time)[joint] - pose
            sag += SAG_LEARNING_RATE * (found - sag) if abs(found) <= MAX_SAG else -sag
            self._sag[joint] = sag
        return pose + sag

    def _command(self, target: JointAngles, now: float) -> JointAngles:
        self._commanded.add(now, target)
        return target

    def clamped(self, angles: Mapping[str, float]) -> JointAngles:
        """Return the nearest angles inside the limits of bindings, joints and coupled joints [rad]."""
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
        """Return the joint's search amplitude [rad]; its sign is that of the side on which the face was seen last."""
        sweep = self.controller.tracking.sweep
        far = sweep.get(joint, 0.0) if sweep else SEARCH_SWING * (joint == self.joints[0])
        return -far if self._turn.get(joint, 0.0) < 0.0 else far

    def _take(self, fields: Mapping[str, Any], route: str | None) -> bool:
        """Store the input fields of a message; return True once every input has a value."""
        for binding in self.controller.input_bindings:
            if route in (None, binding.route):
                if (value := number_at(fields, binding.path)) is None:
                    return False
                self._inputs[binding.variable] = value
        return self._inputs.keys() == self.controller.inputs.keys()
