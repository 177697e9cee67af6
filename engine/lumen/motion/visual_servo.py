"""Computes the angle to turn for one sighting, from the angles of the joints when the image was taken.

The plain answer is the controller's output times the binding's gain. Under minimum and maximum that answer has a flaw:
as long as the term in the middle fires enough to cover the others, the centroid does not move at all. With Tables 1 and
2 of the paper the head rests anywhere within 45 px of the face. Two remedies, both in the controller's `track:`.

`zoom`: the image is evaluated magnified about the inputs' neutral points, and the answer is divided by the
magnification; the largest of these answers counts (`Magnifier`). So the surface keeps its steepest slope down to the
centre.

`looks`: the controller is evaluated again, for the image as the head would see it after the turn so far. So what one
step of a flat surface leaves over need not wait for the next image.
"""

from bisect import bisect_left, bisect_right
from collections import deque
from collections.abc import Mapping

from lumen.fuzzy.magnification import Magnifier
from lumen.language.controllers import ControllerDefinition
from lumen.language.robots import Body
from lumen.language.roles import HEAD_PITCH, HEAD_YAW, JointRole
from lumen.motion.projection import after_turning

JointAngles = dict[str, float]


class JointHistory:
    """The angles [rad] of some joints at increasing times [s]; entries older than `memory` [s] are dropped."""

    def __init__(self, memory: float) -> None:
        self.memory = memory
        self.known: deque[tuple[float, JointAngles]] = deque()

    def __bool__(self) -> bool:
        return bool(self.known)

    @property
    def last(self) -> float:
        """The time of the newest entry [s]. Raises IndexError if there is none."""
        return self.known[-1][0]

    def add(self, time: float, angles: Mapping[str, float]) -> None:
        """Store the angles at `time`; ignore them if `time` is not later than all others."""
        if self.known and time <= self.last:
            return
        self.known.append((time, dict(angles)))
        while len(self.known) > 1 and self.known[1][0] < time - self.memory:
            self.known.popleft()

    def at(self, time: float) -> JointAngles:
        """Return the angles at `time`, linearly interpolated and constant before and after all entries."""
        i = bisect_left(self.known, time, key=lambda entry: entry[0])
        if i == 0 or i == len(self.known):
            return dict(self.known[min(i, len(self.known) - 1)][1])
        (t0, before), (t1, after) = self.known[i - 1], self.known[i]
        w = (time - t0) / (t1 - t0)
        return {joint: angle + w * (after[joint] - angle) for joint, angle in before.items()}

    def steady(self, joint: str, start: float, end: float, within: float) -> bool:
        """Return True if the joint's angles from just before `start` to `end` [s] differ by at most `within` [rad]."""
        first = bisect_right(self.known, start, key=lambda entry: entry[0]) - 1
        after = bisect_right(self.known, end, key=lambda entry: entry[0])
        angles = [self.known[i][1][joint] for i in range(max(first, 0), after)]
        return first >= 0 and max(angles) - min(angles) <= within


class VisualServo:
    """Computes how far to turn for one sighting, with a controller bound to joints of a body."""

    def __init__(self, controller: ControllerDefinition, body: Body) -> None:
        self._controller, self._body = controller, body
        self._yaw, self._pitch = body.roles.joint(HEAD_YAW), body.roles.joint(HEAD_PITCH)
        self._magnifier = Magnifier(controller)
        self._bindings = [b for b in controller.output_bindings if b.joint in body.joints]
        self._across, self._down = _image_inputs(controller)
        self._previous: dict[str, float] = {}

    def turn(self, inputs: Mapping[str, float], pose: Mapping[str, float], lived: Mapping[str, float]) -> JointAngles:
        """Return the turn of each joint [rad] for these inputs, seen with the joints at `pose` plus `lived` [rad].

        `lived` are the offsets of idle life: the turn is computed as if the image had been taken without them.
        """
        turned = dict.fromkeys(pose, 0.0)
        if any(lived.values()):
            there = {joint: angle + lived[joint] for joint, angle in pose.items()}
            inputs = self._after(inputs, there, {joint: -angle for joint, angle in lived.items()}) or inputs
        seen: Mapping[str, float] | None = inputs
        for _ in range(self._controller.tracking.looks):
            for joint, angle in self._once(seen).items() if seen else ():
                turned[joint] += angle
            seen = self._after(inputs, pose, turned)
        return turned

    def _once(self, inputs: Mapping[str, float]) -> JointAngles:
        """Return the turn of each joint [rad] for one image."""
        self._previous = outputs = self._magnifier.answer(inputs, self._previous)
        turn = dict.fromkeys((b.joint for b in self._bindings), 0.0)
        for binding in self._bindings:
            turn[binding.joint] += outputs[binding.variable] * binding.gain * binding.angle
        return turn

    def _after(
        self, inputs: Mapping[str, float], pose: Mapping[str, float], turned: Mapping[str, float]
    ) -> dict[str, float] | None:
        """Return the inputs that the camera would see after the turn; None if they can't be computed."""
        yaw, pitch, camera = self._yaw, self._pitch, self._body.camera
        if not (self._across and self._down and camera and (yaw or pitch)):
            return None
        if any(role and role.joint not in pose for role in (yaw, pitch)):
            return None
        before = _angle(yaw, pose), _angle(pitch, pose)
        after = before[0] + _angle(yaw, turned), before[1] + _angle(pitch, turned)
        pixel = after_turning((inputs[self._across], inputs[self._down]), camera, before, after)
        return {**inputs, self._across: pixel[0], self._down: pixel[1]} if pixel else None


def _angle(role: JointRole | None, angles: Mapping[str, float]) -> float:
    """Return the angle of a role [rad]; 0 if the head does not turn that way."""
    return role.sign * angles[role.joint] if role else 0.0


def _image_inputs(controller: ControllerDefinition) -> tuple[str, str]:
    """Return the inputs that are image coordinates: pixels to the right, and down; empty strings if there are none."""
    found = {v.direction: name for name, v in controller.inputs.items() if v.unit == "px"}
    return found.get("right", ""), found.get("down", "")
