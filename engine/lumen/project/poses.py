"""Read joint angles of a keyframe [rad; hands 0..1]: postures of the body, the file's poses, joints and hands."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import degrees, isfinite, pi
from typing import Any

from lumen.language.diagnostics import ERROR, Code, NodePath, did_you_mean
from lumen.language.mirrors import Mirror, mirror_of
from lumen.language.robots import Body
from lumen.language.roles import JointRole
from lumen.project.document_report import DocumentReport
from lumen.project.numbers import NOT_A_NUMBER
from lumen.project.roles import OUT_OF_REACH, RoleNames
from lumen.project.units import ANGLES, JointUnits, seconds

UNKNOWN_JOINT = Code("unknown-joint", "references", ERROR, "the robot has no joint of that name")
UNKNOWN_POSE = Code("unknown-pose", "references", ERROR, "the named pose is not defined in the motion")
UNKNOWN_POSTURE = Code("unknown-posture", "references", ERROR, "the robot has no posture of that name")
ANGLE_OUT_OF_RANGE = Code("angle-out-of-range", "motions", ERROR, "an angle is outside the joint's limits")
HAND_OUT_OF_RANGE = Code("hand-out-of-range", "motions", ERROR, "a hand is opened to less than 0 or more than 1")
SHARED_DRIVE = Code("shared-drive", "motions", ERROR, "two joints with one motor have different angles")


PlacedAngles = dict[str, tuple[float, NodePath]]
"""By joint, the angle [rad; a hand 0..1] and its place in the file."""

Handles = dict[str, tuple[tuple[float, float], tuple[float, float]]]

DRIVE_TOLERANCE = 1e-6


@dataclass
class PoseReader:
    """Reads the joint angles of one file, in the units of the file."""

    report: DocumentReport
    body: Body
    units: JointUnits
    poses: dict[str, PlacedAngles] = field(default_factory=dict)
    mirror: Mirror = field(init=False)
    roles: RoleNames = field(init=False)

    def __post_init__(self) -> None:
        self.mirror, self.roles = mirror_of(self.body), RoleNames(self.report, self.body)

    def define(self, poses: Mapping[str, Any], path: NodePath) -> None:
        """Add the poses under `poses:`; each may use those above it."""
        for name, pose in poses.items():
            angles = self.read(pose, (*path, name))
            self.poses[name] = _mirrored(angles, self.mirror) if pose.get("mirror") else angles

    def read(self, item: Mapping[str, Any], here: NodePath) -> PlacedAngles:
        """Return the angles of a keyframe or pose: posture, poses, `roles`, `joints`, `hands`; later ones override."""
        angles: PlacedAngles = {}
        if "posture" in item:
            angles |= self._posture(item["posture"], (*here, "posture"))
        names = item.get("pose", [])
        for i, name in enumerate([names] if isinstance(names, str) else names):
            angles |= self._pose(name, (*here, "pose") if isinstance(names, str) else (*here, "pose", i))
        own = self._by_role(item.get("roles") or {}, (*here, "roles"))
        own |= self._joints(item.get("joints") or {}, (*here, "joints"))
        own |= self._hands(item.get("hands") or {}, (*here, "hands"))
        return self._shared(angles | own, own)

    def posture(self, name: str, path: NodePath) -> Mapping[str, float] | None:
        """Return the angles of a posture [rad]; if the robot has no such posture, report the fault and return None."""
        if name in self.body.postures:
            return self.body.postures[name]
        hint = did_you_mean(name, self.body.postures, f"{self.body.name} has")
        self.report(UNKNOWN_POSTURE, path, f"there is no posture `{name}`", hint=hint, cause=f"posture {name}")
        return None

    def number(self, value: float, path: NodePath) -> bool:
        """Return True if a number is finite; otherwise, report the number."""
        if not isfinite(value):
            self.report(NOT_A_NUMBER, path, f"`{value}` can't be used here", hint="write a finite number")
        return isfinite(value)

    def handles(self, item: Mapping[str, Any], here: NodePath) -> Handles:
        """Return the Bezier handles of a keyframe, as (dt [s], da [rad]) before and after the key."""
        found: Handles = {}
        for name, sides in (item.get("handles") or {}).items():
            path = (*here, "handles", name)
            if role := self._named(name, path):
                joint, sign = role.joint, role.sign
                before, after = (self._handle(joint, sign, sides, side, path) for side in ("in", "out"))
                found[joint] = before, after
        return found

    def _named(self, name: str, path: NodePath) -> JointRole | None:
        """Return the joint of that name or role; if the body lacks it, report the fault and return None."""
        if "." in name:
            return self.roles.joint(name, path)
        return JointRole(name) if self._known(name, path) else None

    def _by_role(self, roles: Mapping[str, float], path: NodePath) -> PlacedAngles:
        """Return the angles given by role; one that a joint can't reach is reported and set to its limit."""
        found: PlacedAngles = {}
        for name, value in roles.items():
            here = (*path, name)
            if (role := self.roles.joint(name, here)) is None or not self.number(value, here):
                continue
            if role.joint in self.body.hands:
                found |= self._hand(role.joint, value, here)
                continue
            joint, factor = self.body.joints[role.joint], self.units.factor(role.joint, self.body)
            angle = role.sign * value * factor
            if not self._fits(role.joint, angle):
                low, high = sorted(role.sign * end / factor for end in (joint.minimum, joint.maximum))
                unit = self.units.name(role.joint, self.body)
                message = f"{self.body.name} can't bring `{name}` to {value:g} {unit}: it stops at its limit"
                hint = f"its range is {round(low, 4):g} to {round(high, 4):g} {unit}"
                self.report(OUT_OF_REACH, here, message, hint=hint)
                angle = min(max(angle, joint.minimum), joint.maximum)
            found[role.joint] = angle, here
        return found

    def _handle(
        self, joint: str, sign: float, sides: Mapping[str, Any], side: str, path: NodePath
    ) -> tuple[float, float]:
        handle = sides.get(side) or {}
        dt, da = seconds(handle.get("before" if side == "in" else "after")), handle.get("angle", 0)
        if dt is None or not self.number(da, (*path, side, "angle")):
            return 0.0, 0.0
        turned = 1.0 if joint in self.body.hands else sign
        return (-dt if side == "in" else dt), da * turned * self.units.factor(joint, self.body)

    def _posture(self, name: str, path: NodePath) -> PlacedAngles:
        return {joint: (angle, path) for joint, angle in (self.posture(name, path) or {}).items()}

    def _pose(self, name: str, path: NodePath) -> PlacedAngles:
        if name not in self.poses and ("poses",) not in self.report.pruned:
            hint = did_you_mean(name, self.poses, "`poses` has")
            cause = f"{self.report.document.file} pose {name}"
            self.report(UNKNOWN_POSE, path, f"there is no pose `{name}`", hint=hint, cause=cause)
        return {joint: (angle, path) for joint, (angle, _) in self.poses.get(name, {}).items()}

    def _joints(self, joints: Mapping[str, float], path: NodePath) -> PlacedAngles:
        found: PlacedAngles = {}
        for name, value in joints.items():
            here = (*path, name)
            if not self._known(name, here) or not self.number(value, here):
                continue
            if name in self.body.hands:
                found |= self._hand(name, value, here)
            elif self._inside(name, value, here):
                found[name] = value * self.units.factor(name, self.body), here
        return found

    def lags(self, trails: Mapping[str, str], path: NodePath) -> dict[str, float]:
        """Return the delay of each joint under `trails` [s]; joints that share a motor have the same delay."""
        named = {name: self._named(name, (*path, name)) for name in trails}
        found = {role.joint: seconds(trails[name]) or 0.0 for name, role in named.items() if role}
        twins = {**self.body.shared, **{leader: follower for follower, leader in self.body.shared.items()}}
        return {**{twins[name]: lag for name, lag in found.items() if name in twins}, **found}

    def _known(self, joint: str, path: NodePath) -> bool:
        if joint not in self.body.joints:
            hint = did_you_mean(joint, self.body.joints, f"{self.body.name} has")
            self.report(
                UNKNOWN_JOINT, path, f"there is no joint `{joint}`", hint=hint, key=True, cause=f"joint {joint}"
            )
        return joint in self.body.joints

    def _inside(self, name: str, value: float, path: NodePath) -> bool:
        joint, factor = self.body.joints[name], self.units.factor(name, self.body)
        if self._fits(name, value * factor):
            return True
        unit = self.units.name(name, self.body)
        low, high = (round(limit / factor, 4) for limit in (joint.minimum, joint.maximum))
        hint = f"its range is {low:g} to {high:g} {unit}"
        if unit == "deg" and abs(value) < 3.2 and self._fits(name, value):
            hint = f"this file uses degrees: write {degrees(value):.4g}; {hint}"
        cause, root = "", f"the range of `{name}` in models/"
        if unit == "rad" and self._fits(name, value * ANGLES["deg"]):
            root = f"`units` in {self.report.document.file}"
            cause = root if abs(value) > 2 * pi else ""
        if cause:
            hint = f"write `units: {{angle: deg}}` at the top if these are degrees; {hint}"
        elif self.mirror.get(name, ("",))[0] not in ("", name) and self._fits(name, -value * factor):
            hint = (
                f"left and right joints turn in opposite directions: write {-value:g} if that is what you mean; {hint}"
            )
        message = f"`{name}` can't go to {value:g} {unit}"
        self.report(ANGLE_OUT_OF_RANGE, path, message, hint=hint, cause=cause, root=root)
        return False

    def _fits(self, name: str, angle: float) -> bool:
        joint = self.body.joints[name]
        return joint.minimum - DRIVE_TOLERANCE <= angle <= joint.maximum + DRIVE_TOLERANCE

    def _hands(self, hands: Mapping[str, float], path: NodePath) -> PlacedAngles:
        found: PlacedAngles = {}
        for side, value in hands.items():
            if self.number(value, (*path, side)) and (hand := self.roles.joint(f"hands.{side}", (*path, side))):
                found |= self._hand(hand.joint, value, (*path, side))
        return found

    def _hand(self, joint: str, value: float, path: NodePath) -> PlacedAngles:
        if 0.0 <= value <= 1.0:
            return {joint: (value, path)}
        hint = "write a number from 0 (closed) to 1 (open)"
        self.report(HAND_OUT_OF_RANGE, path, f"a hand can't be opened to {value:g}", hint=hint)
        return {}

    def _shared(self, angles: PlacedAngles, own: PlacedAngles) -> PlacedAngles:
        """Return the angles with both joints of each shared motor set alike; report different angles for them."""
        for follower, leader in self.body.shared.items():
            if follower in own and leader in own and abs(own[follower][0] - own[leader][0]) > DRIVE_TOLERANCE:
                message = f"`{leader}` and `{follower}` share one motor, so they can't have different angles"
                self.report(SHARED_DRIVE, own[follower][1], message, hint=f"give only `{leader}`")
            chosen = next((source[j] for source in (own, angles) for j in (leader, follower) if j in source), None)
            if chosen:
                angles |= {leader: chosen, follower: chosen}
        return angles


def _mirrored(angles: PlacedAngles, mirror: Mirror) -> PlacedAngles:
    turned = ((*mirror.get(joint, (joint, 1.0)), *placed) for joint, placed in angles.items())
    return {other: (sign * angle, where) for other, sign, angle, where in turned if other}
