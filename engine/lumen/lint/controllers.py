"""Checks of controllers: their bindings to joints, and further checks of files without faults."""

from lumen.language.controllers import ControllerDefinition, OutputBinding
from lumen.language.diagnostics import NodePath, did_you_mean
from lumen.language.robots import Body
from lumen.lint import aims, rulebooks, shapes, surfaces
from lumen.lint.lookups import first
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft
from lumen.project.memoization import memoize
from lumen.project.poses import ANGLE_OUT_OF_RANGE, UNKNOWN_JOINT
from lumen.project.roles import RoleNames

LIMIT_TOLERANCE = 2e-3
"""The tolerance [rad] by which a limit can exceed the joint's limit, because people round."""


def check(draft: ProjectDraft) -> None:
    """Report bindings to joints that the robot does not have, and limits beyond those of a joint."""
    for name, controller in draft.controllers.items():
        report = draft.report("fuzzy", name)
        if draft.body and draft.settings:
            lost = draft.report("models", draft.settings.model).lost
            _joints(controller, report, draft.body, lost)
        if report.whole and not report.diagnostics:
            _sense(controller, report, draft, name)


def _sense(controller: ControllerDefinition, report: DocumentReport, draft: ProjectDraft, name: str) -> None:
    rulebooks.check(controller, report)
    shapes.check(controller, report)
    aims.check(controller, report, draft)
    given = draft.files[f"fuzzy/{name}.yaml"]
    surfaces.check(controller, report, memoize(("surface", name), given, lambda: surfaces.sample_surface(controller)))


def _joints(controller: ControllerDefinition, report: DocumentReport, body: Body, lost: set[str]) -> None:
    roles = RoleNames(report, body)
    for binding in controller.output_bindings:
        path: NodePath = ("bind", "outputs", binding.variable)
        if "." in binding.joint:
            roles.joint(binding.joint, (*path, "joint"))
            continue
        if _known(report, (*path, "joint"), binding.joint, body, lost):
            _limits(controller, report, (*path, "limits"), binding, body)
    for what, joints in (("sweep", controller.tracking.sweep), ("ahead", controller.tracking.ahead)):
        for joint in joints:
            path = ("track", what, joint)
            if "." in joint:
                roles.joint(joint, path)
            else:
                named = next((name for name in body.roles.paths if body.roles.name(name) == joint), joint)
                _known(report, first(report, path, ("track", what, named)), joint, body, lost, key=True)
    roles.tell_left_out("this controller")


def _known(
    report: DocumentReport, path: NodePath, joint: str, body: Body, lost: set[str], *, key: bool = False
) -> bool:
    if joint not in body.joints and joint not in lost:
        hint = did_you_mean(joint, body.joints, f"{body.name} has")
        report(UNKNOWN_JOINT, path, f"there is no joint `{joint}`", hint, key=key, cause=f"joint {joint}")
    return joint in body.joints


def _limits(
    controller: ControllerDefinition, report: DocumentReport, path: NodePath, binding: OutputBinding, body: Body
) -> None:
    joint = body.joints[binding.joint]
    for i, limit in enumerate((binding.minimum, binding.maximum)):
        if limit is not None and not joint.minimum - LIMIT_TOLERANCE <= limit <= joint.maximum + LIMIT_TOLERANCE:
            low, high, given = (round(angle / controller.angle, 1) for angle in (joint.minimum, joint.maximum, limit))
            message = f"`{joint.name}` can't move to {given:g}"
            report(ANGLE_OUT_OF_RANGE, (*path, i), message, f"write a limit from {low:g} to {high:g}")
