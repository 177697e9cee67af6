"""Read `roles` of `models/NAME.yaml`, which assigns joints and sensors to parts of the body, as `Roles`.

It also finds the joints of roles that motions name, such as `head.yaw`.
"""

from collections.abc import Callable, Collection, Iterator, Mapping
from typing import Any

from lumen.language.diagnostics import ERROR, INFO, WARNING, Code, NodePath, did_you_mean
from lumen.language.robots import Body
from lumen.language.roles import JOINT_PATHS, LEG_ROLES, SIDES, Base, EyeRoles, JointRole, Roles, SensorRoles
from lumen.project.complaints import MISSING_KEY
from lumen.project.document_report import DocumentReport
from lumen.project.sections import read_fields

UNKNOWN_ROLE = Code("unknown-role", "references", ERROR, "no robot's body has a role of that name")
LEFT_OUT = Code("left-out", "robot", INFO, "the robot can't do an action or a movement, so it is left out")
OUT_OF_REACH = Code("out-of-reach", "motions", WARNING, "the angle of a role is outside the joint's limits")


class RoleNames:
    """Finds the joints of roles in a body, and records which roles it lacks and where each was first named."""

    def __init__(self, report: DocumentReport, body: Body) -> None:
        self._report, self._body = report, body
        self._lacking: dict[str, NodePath] = {}

    def joint(self, name: str, path: NodePath) -> JointRole | None:
        """Return the joint of a role; None if the body lacks it, or if there is no such role, which is reported."""
        if name not in JOINT_PATHS:
            hint = did_you_mean(name, JOINT_PATHS, "the roles are")
            self._report(UNKNOWN_ROLE, path, f"there is no role `{name}`", hint=hint, key=True, cause=f"role {name}")
            return None
        if (role := self._body.roles.joint(name)) is None:
            self._lacking.setdefault(name, path)
        return role

    def some(self, data: Mapping[str, Any], path: NodePath) -> bool:
        """Return True if the data names joints, by role or by name; otherwise, report the fault."""
        here = "roles" in data or "joints" in data
        if not (here or self._report.broken((*path, "joints")) or self._report.broken((*path, "roles"))):
            hint = "write `roles: {head.pitch: 5}`, or `joints` for this robot alone"
            self._report(MISSING_KEY, path, "this moves nothing: it needs `roles` or `joints`", hint=hint, key=True)
        return here

    def tell_left_out(self, what: str) -> None:
        """Report together all named roles that the body lacks; `what` is the item that leaves them out."""
        if lacking := {name: path for name, path in self._lacking.items() if name not in self._report.lost}:
            names = ", ".join(f"`{name}`" for name in lacking)
            hint = "if the body has these joints, name them under `roles` of the body"
            message = f"{self._body.name} has no {names}, so {what} can't move {'them' if len(lacking) > 1 else 'it'}"
            self._report(LEFT_OUT, next(iter(lacking.values())), message, hint=hint, key=True)


INCOMPLETE_ROLE = Code("incomplete-role", "robot", ERROR, "a role needs another role that is missing")
JOINT_IN_TWO_ROLES = Code("joint-in-two-roles", "robot", ERROR, "one joint has two roles")

_HERE: NodePath = ("roles",)
_WALKING_SENSORS = ("gyro", "accelerometer")


class RoleReader:
    """Reads the roles of one file.

    `known` returns True if a joint of this name exists; otherwise, it reports the name at the path. `given` are the
    keys of the file, some of which a role may need; `hands` are the joints with an opening instead of an angle. Only a
    body that is `modelled` in an MJCF needs to name its wheels.
    """

    def __init__(
        self,
        data: Mapping[str, Any],
        report: DocumentReport,
        known: Callable[[str, NodePath], bool],
        given: Collection[str],
        hands: Collection[str],
        *,
        modelled: bool = True,
    ) -> None:
        self.data, self.report, self.known, self.given, self.hands = data, report, known, given, hands
        self.modelled = modelled
        self._owner: dict[str, NodePath] = {}
        self._sound = True

    def read(self, length: float, angle: float) -> Roles:
        """Return the roles; `length` and `angle` are one unit of the file in [m] and [rad]."""
        data = self.data
        eyes, sensors = data.get("eyes") or {}, data.get("sensors") or {}
        roles = Roles(
            torso=data.get("torso", ""),
            head=self._joints(data.get("head"), "head"),
            body=self._joints(data.get("body"), "body"),
            eyes=read_fields(EyeRoles, eyes),
            arms=self._limbs("arms"),
            hands=self._joints(data.get("hands"), "hands"),
            antennas=self._joints(data.get("antennas"), "antennas"),
            legs=self._limbs("legs"),
            soles=_sides(data.get("soles")),
            base=_base(data.get("base") or {}, length, angle),
            sensors=SensorRoles(
                sensors.get("gyro", ""),
                sensors.get("accelerometer", ""),
                _sides(sensors.get("sonar")),
                {side: tuple(sites) for side, sites in _sides(sensors.get("force")).items()},
            ),
            lights={group: tuple(names) for group, names in (data.get("lights") or {}).items()},
        )
        if self._sound and not self.report.broken(_HERE):
            self._whole(roles)
        return roles

    def _limbs(self, kind: str) -> dict[str, dict[str, JointRole]]:
        limbs = self.data.get(kind) or {}
        return {side: self._joints(limbs[side], kind, side) for side in SIDES if side in limbs}

    def _joints(self, roles: Mapping[str, Any] | None, *path: str) -> dict[str, JointRole]:
        found = {name: self._joint(role, (*_HERE, *path, name)) for name, role in (roles or {}).items()}
        return {name: role for name, role in found.items() if role}

    def _joint(self, role: str | Mapping[str, Any], path: NodePath) -> JointRole | None:
        where = path if isinstance(role, str) else (*path, "joint")
        name = role if isinstance(role, str) else role.get("joint")
        if name is None or not self.known(name, where):
            self._sound = False
            self.report.lost.add(_written(path))
            return None
        first = self._owner.setdefault(name, path)
        if first != path:
            message = f"the joint `{name}` has two roles: `{_written(first)}` and `{_written(path)}`"
            related = [(first, "the other role is here")]
            self.report(JOINT_IN_TWO_ROLES, where, message, hint="give each joint one role only", related=related)
        return JointRole(name, not isinstance(role, str) and role.get("reversed", False))

    def _whole(self, roles: Roles) -> None:
        """Report roles that need others which are absent."""
        row = roles.base.row
        if row.legs and (lacking := list(_lacking_for_feet(roles))):
            self._say(("base", "kind"), row.title, lacking)
        wheels = row.wheels and self.modelled
        if wheels and (lacking := [f"base.{side}" for side in SIDES if not getattr(roles.base, side)]):
            self._say(("base", "kind"), row.title, lacking)
        if roles.eyes.camera and "camera" not in self.given:
            message = f"the body does not describe what the camera `{roles.eyes.camera}` sees"
            hint = "add `camera` with width, height, angles of view and position"
            self.report(INCOMPLETE_ROLE, (*_HERE, "eyes", "camera"), message, hint=hint)
        if roles.sensors.sonar and "sonar" not in self.given:
            hint = "add `sonar` with its range and cone"
            self.report(
                INCOMPLETE_ROLE, (*_HERE, "sensors", "sonar"), "the body does not describe its sonars", hint=hint
            )
        for side, hand in roles.hands.items():
            if hand.joint not in self.hands:
                message = (
                    f"`{hand.joint}` is a hand, but has an angle instead of an opening from 0 (closed) to 1 (open)"
                )
                hint = f"add `opening: true` to the joint `{hand.joint}`"
                self.report(INCOMPLETE_ROLE, (*_HERE, "hands", side), message, hint=hint)

    def _say(self, path: NodePath, who: str, lacking: list[str]) -> None:
        hint = "name them under `roles`, or choose another kind of base"
        named = ", ".join(f"`{name}`" for name in lacking)
        self.report(INCOMPLETE_ROLE, (*_HERE, *path), f"{who} needs {named}", hint=hint)


def _lacking_for_feet(roles: Roles) -> Iterator[str]:
    if not roles.torso:
        yield "torso"
    for side in SIDES:
        leg = roles.legs.get(side)
        yield from (f"legs.{side}.{name}" for name in LEG_ROLES if name not in leg) if leg else (f"legs.{side}",)
    yield from (f"soles.{side}" for side in SIDES if not roles.soles.get(side))
    yield from (f"sensors.{name}" for name in _WALKING_SENSORS if not getattr(roles.sensors, name))


def _base(data: Mapping[str, Any], length: float, angle: float) -> Base:
    return read_fields(Base, data, speed=data.get("speed", 0.0) * length, turn=data.get("turn", 0.0) * angle)


def _sides(data: Mapping[str, Any] | None) -> dict[str, Any]:
    return {side: data[side] for side in SIDES if data and side in data}


def _written(path: NodePath) -> str:
    """Return a role as messages write it: `arms.left.elbow-roll`."""
    return ".".join(str(key) for key in path[1:])
