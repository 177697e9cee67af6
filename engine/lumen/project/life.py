"""Build styles of life, `motions/life/NAME.yaml`, and libraries of gestures, from the plain data of their files."""

from collections.abc import Mapping
from typing import Any

from lumen.language.diagnostics import ERROR, Code, NodePath, did_you_mean
from lumen.language.gestures import Gesture, GestureLibrary
from lumen.language.life import STILL, Asides, Blinks, EyeColours, Glances, LifeStyle, Nods, Settles, Sway
from lumen.language.robots import Body
from lumen.project.document_report import DocumentReport
from lumen.project.poses import UNKNOWN_JOINT, PoseReader
from lumen.project.roles import RoleNames
from lumen.project.sections import read_fields
from lumen.project.units import ANGLES, BAD_DURATION, JointUnits, joint_units, seconds

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


SHORTEST_PERIOD = 0.1
"""The minimum time between two repetitions of a movement [s]."""

RESERVED_LIFE = Code("reserved-life", "motions", ERROR, "a style of life is called `still`")


def build_life(data: Any, report: DocumentReport, *, name: str, body: Body) -> LifeStyle | None:
    """Return the style that the data describes; None if the data is not a map or its units are broken."""
    if not isinstance(data, Mapping) or report.broken(("units",)):
        return None
    if name == STILL:
        hint = "give the file another name, or delete it"
        report(RESERVED_LIFE, (), "`still` always means that the robot does nothing, and needs no file", hint=hint)
    reader = _LifeReader(report, body, joint_units(data))
    style = reader.read(data, name)
    reader.roles.tell_left_out("this style of life")
    return style


class _LifeReader:
    """Reads one file of a style of life."""

    def __init__(self, report: DocumentReport, body: Body, units: JointUnits) -> None:
        self._report, self._body, self._units = report, body, units
        self._factor = ANGLES.get(units.angle, 1.0)
        self.roles = RoleNames(report, body)

    def read(self, data: Mapping[str, Any], name: str) -> LifeStyle:
        glances, nods, blinks = (data.get(key) or {} for key in ("glances", "nods", "blinks"))
        eyes = data.get("eyes", "")
        return LifeStyle(
            name,
            tuple(self._sway(key, each) for key, each in (data.get("sways") or {}).items()),
            Glances(
                self._every("glances", glances),
                self._factor * glances["yaw"],
                self._factor * glances["pitch"],
                seconds(glances.get("hold", "1s")) or 0.0,
            )
            if glances
            else None,
            Nods(self._every("nods", nods), self._factor * nods["pitch"]) if nods else None,
            Blinks(self._every("blinks", blinks), seconds(blinks.get("length", "150ms")) or 0.0) if blinks else None,
            seconds(data.get("attention")) or 0.0,
            EyeColours(**eyes) if isinstance(eyes, Mapping) else EyeColours(eyes, eyes, eyes),
            self._asides(data["asides"]) if "asides" in data else None,
            self._settles(data["settles"]) if "settles" in data else None,
            tuple(data.get("naoqi", ())),
        )

    def _asides(self, data: Mapping[str, Any]) -> Asides:
        hold = seconds(data.get("hold", "600ms")) or 0.0
        return Asides(self._factor * data["yaw"], self._factor * data["pitch"], hold)

    def _settles(self, data: Mapping[str, Any]) -> Settles:
        takes = self._time(("settles", "takes"), data.get("takes", "1.5s"))
        return Settles(self._joints(data, ("settles",)), takes)

    def _sway(self, name: str, data: Mapping[str, Any]) -> Sway:
        where = ("sways", name)
        period = self._time((*where, "period"), data["period"])
        return Sway(name, period, self._joints(data, where), data.get("wanders", False), where)

    def _joints(self, data: Mapping[str, Any], path: NodePath) -> dict[str, float]:
        """Return the values under `roles` and `joints` by joint, in SI units; `joints` overrides `roles`."""
        found: dict[str, float] = {}
        self.roles.some(data, path)
        for name, value in (data.get("roles") or {}).items():
            if role := self.roles.joint(name, (*path, "roles", name)):
                turned = 1.0 if role.joint in self._body.hands else role.sign
                found[role.joint] = value * turned * self._units.factor(role.joint, self._body)
        for joint, value in (data.get("joints") or {}).items():
            if joint not in self._body.joints:
                hint = did_you_mean(joint, self._body.joints, f"{self._body.name} has")
                message = f"there is no joint `{joint}`"
                where = (*path, "joints", joint)
                self._report(UNKNOWN_JOINT, where, message, hint=hint, key=True, cause=f"joint {joint}")
            else:
                found[joint] = value * self._units.factor(joint, self._body)
        return found

    def _every(self, key: str, data: Mapping[str, Any]) -> float:
        return self._time((key, "every"), data["every"])

    def _time(self, path: NodePath, text: str) -> float:
        """Return a duration [s]; one below SHORTEST_PERIOD is reported and raised to it."""
        time = seconds(text) or 0.0
        if time < SHORTEST_PERIOD:
            hint = f"write at least {1000 * SHORTEST_PERIOD:g}ms"
            self._report(BAD_DURATION, path, f"`{text}` is too short for a repeated movement", hint=hint)
        return max(time, SHORTEST_PERIOD)
