"""Build a `GestureLibrary` from the plain data of `motions/gestures/NAME.yaml`."""

from collections.abc import Mapping
from typing import Any

from lumen.language.diagnostics import ERROR, Code, NodePath
from lumen.language.gestures import Gesture, GestureLibrary
from lumen.language.robots import Body
from lumen.project.document_report import DocumentReport
from lumen.project.field_reader import read_fields
from lumen.project.poses import PoseReader
from lumen.project.units import BAD_DURATION, joint_units, seconds

POSTURE = "Stand"
"""The posture in which a gesture begins and ends."""

GESTURE_LEGS = Code("gesture-legs", "motions", ERROR, "a gesture moves a leg")


def build_gestures(data: Any, report: DocumentReport, *, name: str, body: Body) -> GestureLibrary | None:
    """Return the library that the data describes; None if the data is not a map or its units are broken."""
    if not isinstance(data, Mapping) or report.broken(("units",)):
        return None
    poses = PoseReader(report, body, joint_units(data))
    reader = _GestureReader(report, body, poses)
    read = [reader.read(key, each) for key, each in (data.get("gestures") or {}).items()]
    poses.roles.tell_left_out("gestures")
    return read_fields(GestureLibrary, data, gestures=tuple(filter(None, read)))


class _GestureReader:
    """Reads single gestures: preparation, stroke, hold and retraction, one after the other."""

    def __init__(self, report: DocumentReport, body: Body, poses: PoseReader) -> None:
        self._report, self._body, self._poses = report, body, poses

    def read(self, name: str, data: Mapping[str, Any]) -> Gesture | None:
        where: NodePath = ("gestures", name)
        at, stroke, keys = 0.0, 0.0, list[tuple[float, dict[str, float]]]()
        for phase in ("preparation", "stroke"):
            if phase in data:
                stroke = at
                at += self._takes(data[phase]["takes"], (*where, phase, "takes"))
                keys.append((at, self._offsets(data[phase], (*where, phase))))
        held = at + (seconds(data.get("hold")) or 0.0)
        duration = held + self._takes(data.get("retraction", "600ms"), (*where, "retraction"))
        tracks: dict[str, list[tuple[float, float]]] = {}
        for time, offsets in keys:
            for joint, angle in offsets.items():
                tracks.setdefault(joint, [(0.0, 0.0)]).append((time, angle))
        if not tracks:
            return None
        for keyed in tracks.values():
            if held > keyed[-1][0]:
                keyed.append((held, keyed[-1][1]))
            keyed.append((duration, 0.0))
        tags = data["for"]
        return Gesture(
            name,
            (tags,) if isinstance(tags, str) else tuple(tags),
            {joint: tuple(keyed) for joint, keyed in tracks.items()},
            stroke,
            duration,
            data.get("mirrored", False),
            where,
            {joint: self._poses.mirror[joint] for joint in tracks if joint in self._poses.mirror},
        )

    def _offsets(self, phase: Mapping[str, Any], path: NodePath) -> dict[str, float]:
        stands, found = self._body.postures.get(POSTURE, {}), {}
        self._poses.roles.some(phase, path)
        for joint, (angle, place) in self._poses.read(phase, path).items():
            if joint in self._body.parts.get("legs", ()):
                hint = "use only the head, arms and hands here, or write a motion instead"
                self._report(GESTURE_LEGS, place, f"`{joint}` is a joint of the legs", hint=hint, key=True)
            else:
                found[joint] = angle - stands.get(joint, 0.0)
        return found

    def _takes(self, text: str, path: NodePath) -> float:
        time = seconds(text) or 0.0
        if time <= 0.0:
            self._report(BAD_DURATION, path, f"`{text}` is too short for a movement", hint="write at least 100ms")
        return max(time, 0.05)
