"""Write joint curves as a motion file, as far as a body can follow them."""

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise
from math import degrees
from typing import Any

from lumen.language.robots import Body
from lumen.project.formats.conversion_findings import ConversionFindings
from lumen.project.formats.fitting import slowed, too_fast, within_limits
from lumen.project.formats.joint_curves import CurvePoint, JointCurves

TIME_TO_FIRST_POSE = 1.0
"""The time given to the robot to reach a first pose that the file sets at 0 s [s]."""

MIN_KEY_DISTANCE = 1e-3
"""The minimum time between two keys of a joint [s]; of two keys that are closer, the second is left out."""


@dataclass(frozen=True)
class MotionWriter:
    """Converts curves to the data of a motion file for a body; movements beyond its abilities go to `findings`.

    With `retime`, keys that a joint can't reach in time are delayed.
    """

    body: Body
    findings: ConversionFindings
    retime: bool = False

    def data(self, curves: JointCurves, description: str) -> dict[str, Any]:
        """Return the file's data, with `keyframes` empty if no joint moves.

        The motion begins at the robot's current pose, and the robot keeps the motion's last pose.
        """
        possible = {joint: self._possible(joint, points) for joint, points in self._known(curves).items()}
        known = self._later({joint: points for joint, points in possible.items() if points})
        lines = all(point.straight for points in known.values() for point in points)
        ways = known if lines else {joint: _bent(points) for joint, points in known.items()}
        frames: dict[float, dict[str, Any]] = {}
        for joint, points in self._fitted(ways).items():
            for point in points:
                frame = frames.setdefault(round(point.time, 4), {"joints": {}, "handles": {}})
                frame["joints"][joint] = self._angle(joint, point.angle)
                if handles := self._handles(joint, point):
                    frame["handles"][joint] = handles
        keyframes = [
            {"at": _length(time), **{key: part for key, part in frames[time].items() if part}}
            for time in sorted(frames)
        ]
        return {
            "description": description,
            "units": {"angle": "deg"},
            "start": None,
            "end": None,
            "interpolation": "linear" if lines else "bezier",
            "keyframes": keyframes,
        }

    def _known(self, curves: JointCurves) -> JointCurves:
        """Return the curves of joints that the body has; of two joints with one motor, only the leading one.

        Unknown joints are reported, and followers whose curve differs from that of the leading joint.
        """
        found: dict[str, list[CurvePoint]] = {}
        for joint, points in curves.items():
            leader = self.body.shared.get(joint, "")
            if joint not in self.body.joints:
                self.findings.lost(points[0].place, f"{self.body.name} has no joint `{joint}`")
            elif leader in curves:
                if [p[:2] for p in points] != [p[:2] for p in curves[leader]]:
                    message = f"`{joint}` shares its motor with `{leader}` and moves with it"
                    self.findings.changed(points[0].place, message)
            else:
                found[joint] = points
        return found

    def _possible(self, joint: str, points: list[CurvePoint]) -> list[CurvePoint]:
        """Return the points with each angle cut to the joint's limits.

        Points that come too early are reported and left out.
        """
        kept: list[CurvePoint] = []
        for point in points:
            if point.time < 0:
                self.findings.lost(point.place, f"`{joint}` has a key {-point.time:g} s before the motion begins")
            elif kept and point.time < kept[-1].time + MIN_KEY_DISTANCE:
                message = (
                    f"the key of `{joint}` at {point.time:g} s is left out: the key before it is at {kept[-1].time:g} s"
                )
                self.findings.lost(point.place, message, "times must increase")
            else:
                kept.append(point._replace(angle=self._inside(joint, point)))
        return kept

    def _inside(self, joint: str, point: CurvePoint) -> float:
        limits = self.body.joints[joint]
        angle = min(max(point.angle, limits.minimum), limits.maximum)
        if angle != point.angle:
            wanted, limit = self._angle(joint, point.angle), self._angle(joint, angle)
            unit = "" if joint in self.body.hands else " deg"
            message = f"`{joint}` can't reach {wanted:g}{unit}: it goes to {limit:g}{unit}"
            self.findings.changed(point.place, message)
        return angle

    def _later(self, curves: JointCurves) -> JointCurves:
        """Return the curves; if the first pose is at 0 s, delay all keys so that the robot has time to reach it.

        The delay is reported.
        """
        first = min((points[0] for points in curves.values()), key=lambda p: p.time, default=None)
        if first is None or first.time >= MIN_KEY_DISTANCE:
            return curves
        takes = f"the robot takes {TIME_TO_FIRST_POSE:g} s to reach it"
        message = f"the first pose is at 0 s: {takes}, and all other keys are delayed"
        self.findings.changed(first.place, message)
        return {
            joint: [p._replace(time=p.time + TIME_TO_FIRST_POSE) for p in points] for joint, points in curves.items()
        }

    def _fitted(self, curves: JointCurves) -> JointCurves:
        """Return the curves within the body's limits, and with `retime` within its speeds; report the changes."""
        curves = within_limits(curves, self.body, self.findings)
        fast = too_fast(curves, self.body) if self.retime else []
        if not fast:
            return curves
        later = slowed(curves, self.body)
        joints = list(dict.fromkeys(excess.joint for excess in sorted(fast, key=lambda e: -e.value / e.limit)))
        names = ", ".join(f"`{joint}`" for joint in joints[:3]) + (" and others" if len(joints) > 3 else "")
        took, takes = (max(points[-1].time for points in each.values()) for each in (curves, later))
        message = f"{names} would be too fast: the motion takes {takes:.2f} s instead of {took:.2f} s"
        self.findings.changed(min(curves[joint][0].place for joint in joints), message)
        return later

    def _handles(self, joint: str, point: CurvePoint) -> dict[str, dict[str, Any]]:
        found: dict[str, dict[str, Any]] = {}
        if point.handle_in[0] < 0:
            found["in"] = {"before": _length(-point.handle_in[0]), "angle": self._angle(joint, point.handle_in[1])}
        if point.handle_out[0] > 0:
            found["out"] = {"after": _length(point.handle_out[0]), "angle": self._angle(joint, point.handle_out[1])}
        return found

    def _angle(self, joint: str, value: float) -> float:
        """Return an angle in the file's unit: degrees, or 0 to 1 for a hand."""
        shown = round(value if joint in self.body.hands else degrees(value), 4)
        return int(shown) if shown == int(shown) else shown


def _bent(points: Iterable[CurvePoint]) -> list[CurvePoint]:
    """Return the points as Bézier keys: a straight piece gets handles at a third of it, which keep it straight."""
    bent = list(points)
    for i, (one, two) in enumerate(pairwise(bent)):
        if two.straight:
            third = ((two.time - one.time) / 3, (two.angle - one.angle) / 3)
            bent[i] = bent[i]._replace(handle_out=third)
            bent[i + 1] = two._replace(handle_in=(-third[0], -third[1]))
    return [point._replace(straight=False) for point in bent]


def _length(seconds: float) -> str:
    return f"{seconds:.4f}".rstrip("0").rstrip(".") + "s"
