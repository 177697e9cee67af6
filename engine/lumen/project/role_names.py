"""Find the joints of roles that motions name, such as `head.yaw`, and report roles that the body lacks."""

from collections.abc import Mapping
from typing import Any

from lumen.language.diagnostics import ERROR, INFO, WARNING, Code, NodePath, did_you_mean
from lumen.language.robots import Body
from lumen.language.roles import JOINT_PATHS, JointRole
from lumen.project.complaints import MISSING_KEY
from lumen.project.document_report import DocumentReport

UNKNOWN_ROLE = Code("unknown-role", "references", ERROR, "no robot's body has a role of that name")
LEFT_OUT = Code("left-out", "robot", INFO, "the robot can't do an action or a movement, so it is left out")
OUT_OF_REACH = Code("out-of-reach", "motions", WARNING, "the angle of a role is outside the joint's limits")


class RoleNames:
    """Finds the joints of roles in a body, and records which roles it lacks and where each was first named."""

    def __init__(self, report: DocumentReport, body: Body) -> None:
        self._report, self._body = report, body
        self._lacking: dict[str, NodePath] = {}

    def joint(self, name: str, path: NodePath) -> JointRole | None:
        """Return the joint of a role; None if the body has none, or if there is no such role, which is reported."""
        if name not in JOINT_PATHS:
            hint = did_you_mean(name, JOINT_PATHS, "the roles are")
            self._report(UNKNOWN_ROLE, path, f"there is no role `{name}`", hint=hint, key=True, cause=f"role {name}")
            return None
        if (role := self._body.roles.joint(name)) is None:
            self._lacking.setdefault(name, path)
        return role

    def some(self, data: Mapping[str, Any], path: NodePath) -> bool:
        """Return True if the data names joints, by role or by name; report it if it does not."""
        here = "roles" in data or "joints" in data
        if not (here or self._report.broken((*path, "joints")) or self._report.broken((*path, "roles"))):
            hint = "write `roles: {head.pitch: 5}`, or `joints` for this robot alone"
            self._report(MISSING_KEY, path, "this moves nothing: it needs `roles` or `joints`", hint=hint, key=True)
        return here

    def tell_left_out(self, what: str) -> None:
        """Report once all named roles that the body lacks; `what` is the item that leaves them out."""
        if lacking := {name: path for name, path in self._lacking.items() if name not in self._report.lost}:
            names = ", ".join(f"`{name}`" for name in lacking)
            hint = "if the body has these joints, name them under `roles` of the body"
            message = f"{self._body.name} has no {names}, so {what} can't move {'them' if len(lacking) > 1 else 'it'}"
            self._report(LEFT_OUT, next(iter(lacking.values())), message, hint=hint, key=True)
