"""Build a `LifeStyle` from the plain data of `motions/life/NAME.yaml`."""

from collections.abc import Mapping
from typing import Any

from lumen.language.diagnostics import ERROR, Code, NodePath, did_you_mean
from lumen.language.life import STILL, Asides, Blinks, EyeColours, Glances, LifeStyle, Nods, Settles, Sway
from lumen.language.robots import Body
from lumen.project.document_report import DocumentReport
from lumen.project.poses import UNKNOWN_JOINT
from lumen.project.role_names import RoleNames
from lumen.project.units import ANGLES, BAD_DURATION, JointUnits, joint_units, seconds

SHORTEST_PERIOD = 0.1
"""The minimum time between two repetitions of a movement [s]."""

RESERVED_LIFE = Code("reserved-life", "motions", ERROR, "a style of life is called `still`")


def build_life(data: Any, report: DocumentReport, *, name: str, body: Body) -> LifeStyle | None:
    """Return the style that the data of `motions/life/NAME.yaml` describes; None if it is not a map."""
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
    """Reads one file."""

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
        """Return the values of this item by joint, in SI units; `joints` overrides `roles`."""
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
        """Return the time between two repetitions [s]; one below the minimum is reported and raised to it."""
        time = seconds(text) or 0.0
        if time < SHORTEST_PERIOD:
            hint = f"write at least {1000 * SHORTEST_PERIOD:g}ms"
            self._report(BAD_DURATION, path, f"`{text}` is too short for a repeated movement", hint=hint)
        return max(time, SHORTEST_PERIOD)
