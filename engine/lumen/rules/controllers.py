"""Controllers: what they are bound to, and what is said of them where nothing else is wrong."""

from collections.abc import Mapping
from typing import Any

from lumen.interpreters.expressions.expression_findings import UNKNOWN_FIELD
from lumen.language.controllers import ControllerDefinition, InputBinding, OutputBinding
from lumen.language.diagnostics import NodePath, did_you_mean
from lumen.language.robots import Body
from lumen.loading.document_report import DocumentReport
from lumen.loading.draft import ProjectDraft
from lumen.loading.memoization import memoize
from lumen.loading.poses import ANGLE_OUT_OF_RANGE, UNKNOWN_JOINT
from lumen.rules import aims, rulebooks, shapes, surfaces
from lumen.rules.references import known_route

LIMIT_TOLERANCE = 2e-3
"""How far a limit may lie outside the joint's own [rad]: people round."""


def check(draft: ProjectDraft) -> None:
    """Report bindings to routes, fields and joints that are not there, and limits that the joint does not have."""
    for name, controller in draft.controllers.items():
        report = draft.report("fuzzy", name)
        for binding in controller.input_bindings:
            _input(draft, report, binding)
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


def _input(draft: ProjectDraft, report: DocumentReport, binding: InputBinding) -> None:
    path = ("bind", "inputs", binding.variable)
    if not known_route(draft, report, path, binding.route) or draft.settings is None:
        return
    schema: Any = draft.messages.get(draft.settings.routes[binding.route].schema)
    for i, step in enumerate(binding.path):
        fields = schema.get("properties") if isinstance(schema, Mapping) else None
        if not isinstance(fields, Mapping):
            return
        if step not in fields:
            owner = ".".join((binding.route, *binding.path[:i]))
            hint = did_you_mean(step, fields, f"`{owner}` has")
            report(UNKNOWN_FIELD, path, f"the messages of `{owner}` have no `{step}`", hint)
            return
        schema = fields[step]


def _joints(controller: ControllerDefinition, report: DocumentReport, body: Body, lost: set[str]) -> None:
    for binding in controller.output_bindings:
        path: NodePath = ("bind", "outputs", binding.variable)
        if _known(report, (*path, "joint"), binding.joint, body, lost):
            _limits(controller, report, (*path, "limits"), binding, body)
    for what, joints in (("sweep", controller.tracking.sweep), ("ahead", controller.tracking.ahead)):
        for joint in joints:
            _known(report, ("track", what, joint), joint, body, lost, key=True)


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
            message = f"`{joint.name}` can't go to {given:g}"
            report(ANGLE_OUT_OF_RANGE, (*path, i), message, f"it goes from {low:g} to {high:g}")
