"""Joint curves of any origin, and the motion file with the same movement."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from itertools import pairwise
from math import degrees
from typing import Any, NamedTuple

from lumen.formats.conversion_findings import ConversionFindings
from lumen.formats.gestures.literals import MAX_NUMBER
from lumen.language.diagnostics import Place
from lumen.language.robots import Body

TIME_TO_FIRST_POSE = 1.0
"""How long the robot takes to come to a pose that stands at 0 s [s]."""

MIN_KEY_DISTANCE = 1e-3
"""Two times closer than this are one [s]."""

BezierHandle = tuple[float, float]


class CurvePoint(NamedTuple):
    """At `time` [s] a joint stands at `angle` [rad; a hand 0..1]; come to along a line where it is `straight`.

    Handles are (dt [s], da [rad]) as in `lumen.language.motions.Keyframe`; those with dt = 0 are to be chosen.
    """

    time: float
    angle: float
    place: Place
    straight: bool = False
    handle_in: BezierHandle = (0.0, 0.0)
    handle_out: BezierHandle = (0.0, 0.0)


JointCurves = Mapping[str, list[CurvePoint]]
"""For each joint its points, in the order of the file."""


@dataclass(frozen=True)
class MotionWriter:
    """Curves as the data of a motion file for a body; what that body can't do is reported to `findings`."""

    body: Body
    findings: ConversionFindings

    def data(self, curves: JointCurves, description: str) -> dict[str, Any]:
        """The file's data. Nothing is added to the motion: it begins where the robot is, and stays where it ends."""
        possible = {joint: self._possible(joint, points) for joint, points in self._known(curves).items()}
        known = self._later({joint: points for joint, points in possible.items() if points})
        lines = all(point.straight for points in known.values() for point in points)
        frames: dict[float, dict[str, Any]] = {}
        for joint, points in known.items():
            for point in points if lines else _bent(points):
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
        """The curves of joints that the body has, one for each drive."""
        found: dict[str, list[CurvePoint]] = {}
        for joint, points in curves.items():
            leader = self.body.shared.get(joint, "")
            if joint not in self.body.joints:
                self.findings.lost(points[0].place, f"{self.body.name} has no joint `{joint}`")
            elif leader in curves:
                if [p[:2] for p in points] != [p[:2] for p in curves[leader]]:
                    message = f"`{joint}` shares its motor with `{leader}` and goes where that goes"
                    self.findings.changed(points[0].place, message)
            else:
                found[joint] = points
        return found

    def _possible(self, joint: str, points: list[CurvePoint]) -> list[CurvePoint]:
        """The points in the order of time, each within the joint's limits."""
        kept: list[CurvePoint] = []
        for point in points:
            if point.time < 0:
                self.findings.lost(point.place, f"`{joint}` is somewhere {-point.time:g} s before the motion begins")
            elif kept and point.time < kept[-1].time + MIN_KEY_DISTANCE:
                message = f"at {point.time:g} s `{joint}` has a key too late: it has one at {kept[-1].time:g} s already"
                self.findings.lost(point.place, message, "times have to increase")
            else:
                kept.append(point._replace(angle=self._inside(joint, point)))
        return kept

    def _inside(self, joint: str, point: CurvePoint) -> float:
        limits = self.body.joints[joint]
        angle = min(max(point.angle, limits.minimum), limits.maximum)
        if angle != point.angle:
            wanted, limit = self._angle(joint, point.angle), self._angle(joint, angle)
            unit = "" if joint in self.body.hands else " deg"
            message = f"`{joint}` can't go to {wanted:g}{unit}: it goes to {limit:g}{unit}"
            self.findings.changed(point.place, message)
        return angle

    def _later(self, curves: JointCurves) -> JointCurves:
        """The curves, put off where they want the robot to be somewhere at once."""
        first = min((points[0] for points in curves.values()), key=lambda p: p.time, default=None)
        if first is None or first.time >= MIN_KEY_DISTANCE:
            return curves
        takes = f"the robot takes {TIME_TO_FIRST_POSE:g} s to come to it"
        message = f"the first pose stands at 0 s: {takes}, and all else comes later"
        self.findings.changed(first.place, message)
        return {
            joint: [p._replace(time=p.time + TIME_TO_FIRST_POSE) for p in points] for joint, points in curves.items()
        }

    def _handles(self, joint: str, point: CurvePoint) -> dict[str, dict[str, Any]]:
        found: dict[str, dict[str, Any]] = {}
        if point.handle_in[0] < 0:
            found["in"] = {"before": _length(-point.handle_in[0]), "angle": self._angle(joint, point.handle_in[1])}
        if point.handle_out[0] > 0:
            found["out"] = {"after": _length(point.handle_out[0]), "angle": self._angle(joint, point.handle_out[1])}
        return found

    def _angle(self, joint: str, value: float) -> float:
        """In the file's unit: degrees, a hand from 0 to 1."""
        shown = round(value if joint in self.body.hands else degrees(value), 4)
        return int(shown) if shown == int(shown) else shown


def number(text: str) -> float | None:
    """The number that a text holds, None where it holds none, or none that a time or an angle could be."""
    try:
        value = float(text)
    except ValueError:
        return None
    return value if abs(value) < MAX_NUMBER else None


def _bent(points: Iterable[CurvePoint]) -> list[CurvePoint]:
    """The points with handles on the chord, a third of it long, wherever the way to a point is straight."""
    bent = list(points)
    for i, (one, two) in enumerate(pairwise(bent)):
        if two.straight:
            third = ((two.time - one.time) / 3, (two.angle - one.angle) / 3)
            bent[i] = bent[i]._replace(handle_out=third)
            bent[i + 1] = two._replace(handle_in=(-third[0], -third[1]))
    return bent


def _length(seconds: float) -> str:
    return f"{seconds:.4f}".rstrip("0").rstrip(".") + "s"
