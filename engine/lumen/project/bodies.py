"""Build a `Body` from the plain data of a description of a robot's body, `models/NAME.yaml`."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from math import inf, isfinite
from typing import Any

from lumen.language.diagnostics import ERROR, Code, NodePath, did_you_mean
from lumen.language.robots import Body, Camera, CoupledLimit, Joint, LinkInertia, Ultrasound
from lumen.language.roles import Roles
from lumen.project.complaints import MISSING_KEY
from lumen.project.document_report import DocumentReport
from lumen.project.numbers import EMPTY_RANGE
from lumen.project.poses import ANGLE_OUT_OF_RANGE, UNKNOWN_JOINT
from lumen.project.roles import RoleReader
from lumen.project.units import ANGLES, LENGTHS

UNKNOWN_MODEL = Code("unknown-model", "references", ERROR, "the named body is not in models/")
INCOMPLETE_POSTURE = Code("incomplete-posture", "robot", ERROR, "a posture has no angle for a joint")
JOINT_IN_TWO_PARTS = Code("joint-in-two-parts", "robot", ERROR, "a joint belongs to two parts of the body")
JOINT_WITHOUT_PART = Code("joint-without-part", "robot", ERROR, "a joint belongs to no part of the body")
UNSORTED_ROWS = Code("unsorted-rows", "robot", ERROR, "the rows of a table are not in rising order")


GAIT_ANGLES = frozenset(("turn", "lean"))
GAIT_LENGTHS = frozenset(
    (
        "forward",
        "sideways",
        "lift",
        "torso",
        "apart",
        "narrowest",
        "widest",
        "ahead",
        "inside",
        "sole_ahead",
        "sole_aside",
    )
)
"""The parameters of a pace that are lengths in the file's unit. Those neither here nor in GAIT_ANGLES are times [s]."""

NO_MJCF = "none"
"""The value of `mjcf` for a body that is never simulated."""

COMMON_POSTURE = "Stand"
"""The posture that every robot must have, and in which it begins."""

BIPED_POSTURE = "Crouch"
"""The posture in which a two-legged robot may turn its motors off without falling."""

BODY_PARTS = ("head", "arms", "legs", "body")
"""The parts of every body; a part that is missing in a robot has no joints."""

POSTURE_TOLERANCE = 2e-3
"""The maximum distance of a posture beyond a joint's limit [rad]; published postures are rounded."""


def build_body(data: Any, report: DocumentReport, *, name: str) -> Body | None:
    """Return the body that the data of `models/NAME.yaml` describes; None if it has no joints.

    A body with `like` but no joints of its own is built afterwards, by `build_likes`.
    """
    if not isinstance(data, Mapping) or not data.get("joints"):
        return None
    return _Builder(data, report).body(name)


def build_likes(
    bodies: Mapping[str, Body], sources: Mapping[str, tuple[Any, DocumentReport]], names: Collection[str]
) -> dict[str, Body]:
    """Return the given bodies, and those that are `like` one of them.

    `sources` are the data and the report of each model's file. `names` are the names of all models, including
    unreadable ones, so that a reference to an unreadable model is not reported.
    """
    found = dict(bodies)
    for name, (data, report) in sources.items():
        if not isinstance(data, Mapping) or "like" not in data:
            continue
        if data["like"] in bodies:
            found[name] = _Builder({"joints": {}, **data}, report).like(bodies[data["like"]], name)
        elif data["like"] not in names or "like" in (sources.get(data["like"], ((), None))[0] or ()):
            hint = did_you_mean(data["like"], bodies, "available:") if bodies else "no other model is complete"
            report(
                UNKNOWN_MODEL,
                ("like",),
                f"`like` can't use the model `{data['like']}`: it does not exist, or has a `like` itself",
                hint=hint,
            )
    return found


class _Builder:
    """Reads one body file; the joints come first because everything else refers to them."""

    def __init__(self, data: Mapping[str, Any], report: DocumentReport) -> None:
        self.data, self.report = data, report
        units = data.get("units") or {}
        self.angle = ANGLES.get(units.get("angle", "rad"), 1.0)
        self.length = LENGTHS.get(units.get("length", "m"), 1.0)
        self.joints = {n: joint for n, spec in data["joints"].items() if (joint := self.joint(n, spec))}
        self.hands = tuple(n for n in self.joints if data["joints"][n].get("opening"))
        self.slides = tuple(n for n in self.joints if data["joints"][n].get("sliding"))
        self.unmodelled = data.get("mjcf") == NO_MJCF

    def body(self, name: str) -> Body:
        data, roles = self.data, self.roles()
        return Body(
            name=data.get("name", name),
            mjcf="" if self.unmodelled else data.get("mjcf", f"{name}.xml"),
            joints=self.joints,
            parts=self.parts(),
            postures=self.postures(roles),
            coupled=tuple(c for i, row in enumerate(data.get("coupled") or ()) if (c := self.coupled(i, row))),
            camera=self.camera(data["camera"]) if "camera" in data else None,
            tactile=tuple(data.get("tactile") or ()),
            shared=self.shared(),
            hands=self.hands,
            slides=self.slides,
            sonar=self.sonar(data.get("sonar")),
            links={n: self.link(spec) for n, spec in (data.get("links") or {}).items()},
            roles=roles,
            gait=self.gait(),
            give=(data.get("motors") or {}).get("give", 0.0) * self.angle,
        )

    def like(self, other: Body, name: str) -> Body:
        """Return the other body with the changes that this file makes."""
        data = self.data
        return replace(
            other,
            name=data.get("name", name),
            camera=self.camera(data["camera"]) if "camera" in data else other.camera,
            sonar=self.sonar(data["sonar"]) if "sonar" in data else other.sonar,
            links={**other.links, **{n: self.link(spec) for n, spec in (data.get("links") or {}).items()}},
            gait=self.gait() if "gait" in data else other.gait,
        )

    def gait(self) -> dict[str, dict[str, float]]:
        """Return the parameters of each pace, in SI units."""
        units = {name: self.angle if name in GAIT_ANGLES else self.length for name in GAIT_LENGTHS | GAIT_ANGLES}
        paces = (self.data.get("gait") or {}).items()
        return {pace: {n: v * units.get(n, 1.0) for n, v in found.items()} for pace, found in paces}

    def link(self, spec: Mapping[str, Any]) -> LinkInertia:
        return LinkInertia(spec["mass"], tuple(c * self.length for c in spec["centre"]), tuple(spec["inertia"]))

    def unit(self, name: str) -> float:
        """Return the factor from this joint's unit in the file to SI; 1.0 for the opening of a hand."""
        joint = self.data["joints"][name]
        return 1.0 if joint.get("opening") else self.length if joint.get("sliding") else self.angle

    def joint(self, name: str, spec: Mapping[str, Any]) -> Joint | None:
        if "range" not in spec:
            return None
        low, high = spec["range"]
        if not low < high:
            hint = f"write [{high}, {low}]" if high < low else "write a second number that is greater than the first"
            self.report(
                EMPTY_RANGE, ("joints", name, "range"), f"the range [{low}, {high}] of `{name}` is empty", hint=hint
            )
            self.report.lost.add(name)
            return None
        unit = self.unit(name)
        return Joint(name, low * unit, high * unit, spec.get("speed", inf) * unit, spec.get("effort", inf))

    def known(self, name: str, path: NodePath) -> bool:
        """Return True if a joint exists and could be read; report the name if there is no such joint."""
        if name in self.joints:
            return True
        if name not in self.data["joints"]:
            hint = did_you_mean(name, self.joints, "the joints are")
            self.report(UNKNOWN_JOINT, path, f"`{name}` is not a joint of this robot", hint=hint, cause=f"joint {name}")
        return False

    def roles(self) -> Roles:
        given, hands, data = self.data.keys(), self.hands, self.data.get("roles") or {}
        reader = RoleReader(data, self.report, self.known, given, hands, modelled=not self.unmodelled)
        return reader.read(self.length, self.angle)

    def parts(self) -> dict[str, tuple[str, ...]]:
        parts: dict[str, tuple[str, ...]] = dict.fromkeys(BODY_PARTS, ())
        owner: dict[str, str] = {}
        named = [name for names in (self.data.get("parts") or {}).values() for name in names]
        whole = "parts" in self.data and not self.report.broken(("parts",)) and set(named) <= self.data["joints"].keys()
        for part, names in (self.data.get("parts") or {}).items():
            for i, name in enumerate(names):
                if self.known(name, ("parts", part, i)) and owner.setdefault(name, part) != part:
                    message = f"the joint `{name}` is in two parts: `{owner[name]}` and `{part}`"
                    related = [(("parts", owner[name]), "the other part is here")]
                    hint = "name each joint in one part only"
                    self.report(JOINT_IN_TWO_PARTS, ("parts", part, i), message, hint=hint, related=related)
            parts[part] = tuple(n for n in names if owner.get(n) == part)
        for name in [n for n in self.joints if n not in owner and whole]:
            self.report(
                JOINT_WITHOUT_PART,
                ("joints", name),
                f"the joint `{name}` is in no part",
                hint="add it to one of the `parts`",
            )
        return parts

    def shared(self) -> dict[str, str]:
        pairs = (self.data.get("shared") or {}).items()
        known = [self.known(a, ("shared", a)) and self.known(b, ("shared", a)) for a, b in pairs]
        return {a: b for (a, b), good in zip(pairs, known, strict=True) if good}

    def coupled(self, index: int, spec: Mapping[str, Any]) -> CoupledLimit | None:
        path: NodePath = ("coupled", index)
        if not {"joint", "on", "rows"} <= spec.keys():
            return None
        joint, on, rows = spec["joint"], spec["on"], spec["rows"]
        if not (self.known(joint, (*path, "joint")) and self.known(on, (*path, "on"))):
            return None
        if any(a[0] >= b[0] for a, b in pairwise(rows)):
            message = f"the angles of `{on}` do not rise from row to row"
            self.report(UNSORTED_ROWS, (*path, "rows"), message, hint="sort the rows by their first number")
            return None
        scaled = tuple((a * self.unit(on), b * self.unit(joint), c * self.unit(joint)) for a, b, c in rows)
        return CoupledLimit(joint, on, scaled)

    def postures(self, roles: Roles) -> dict[str, dict[str, float]]:
        """Return the joint angles of each posture, and report required postures that are missing."""
        found = {name: self.posture(name, angles) for name, angles in (self.data.get("postures") or {}).items()}
        for name in (COMMON_POSTURE, BIPED_POSTURE) if roles.base.row.legs else (COMMON_POSTURE,):
            if "postures" in self.data and name not in found and name not in self.report.lost:
                who = "every robot on two legs needs" if name == BIPED_POSTURE else "every robot needs"
                message, hint = f"the robot has no posture `{name}`", f"{who} `{name}`: give the angle of each joint"
                self.report(MISSING_KEY, ("postures",), message, hint=hint, key=True)
        return found

    def posture(self, posture: str, spec: Mapping[str, float]) -> dict[str, float]:
        path: NodePath = ("postures", posture)
        for name in spec:
            self.known(name, (*path, name))
        missing = [n for n in self.joints if n not in spec]
        if missing and not self.report.broken(path) and spec.keys() <= self.data["joints"].keys():
            names = ", ".join(f"`{n}`" for n in missing)
            hint = "add the missing angles: a posture needs one for every joint"
            self.report(INCOMPLETE_POSTURE, path, f"`{posture}` has no angle for {names}", hint=hint, key=True)
        return {n: self.angle_of(n, spec[n], (*path, n)) for n in self.joints if n in spec}

    def angle_of(self, name: str, value: float, path: NodePath) -> float:
        """Return the angle [rad], clipped to the joint's limits; report an angle that exceeds them noticeably."""
        joint, unit = self.joints[name], self.unit(name)
        angle = value * unit
        if not (isfinite(angle) and joint.minimum - POSTURE_TOLERANCE <= angle <= joint.maximum + POSTURE_TOLERANCE):
            message = f"`{name}` can't reach {value}"
            hint = f"write a value from {joint.minimum / unit:.6g} to {joint.maximum / unit:.6g}"
            self.report(ANGLE_OUT_OF_RANGE, path, message, hint=hint, root=f"the range of `{name}` in models/")
        return min(max(angle, joint.minimum), joint.maximum)

    def camera(self, spec: Mapping[str, Any]) -> Camera:
        return Camera(
            width=spec.get("width", 320),
            height=spec.get("height", 240),
            horizontal_fov=spec.get("horizontal_fov", 1.0641 / self.angle) * self.angle,
            vertical_fov=spec.get("vertical_fov", 0.83147 / self.angle) * self.angle,
            position=self.point(spec.get("position", (0.0, 0.0, 0.0))),
            pitch=spec.get("pitch", 0.0) * self.angle,
            **({"neck": self.point(spec["neck"])} if "neck" in spec else {}),
        )

    def point(self, spec: Sequence[float]) -> tuple[float, float, float]:
        """Return a point of the file with its coordinates in [m]."""
        x, y, z = (c * self.length for c in spec)
        return x, y, z

    def sonar(self, spec: Mapping[str, Any] | None) -> Ultrasound | None:
        if not spec or not {"range", "cone"} <= spec.keys():
            return None
        low, high = spec["range"]
        return Ultrasound(low * self.length, high * self.length, spec["cone"] * self.angle)
