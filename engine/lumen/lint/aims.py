"""Bindings of controllers: whether a joint turns in the right direction, within its range, and with a moderate gain."""

from lumen.language.controllers import ControllerDefinition, OutputBinding, Proposition, Variable
from lumen.language.diagnostics import WARNING, Code, NodePath
from lumen.language.robots import Body
from lumen.language.scales import ranks
from lumen.lint.lookups import first
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft

HIGH_GAIN = Code("high-gain", "controllers", WARNING, "the gain of a binding is so high that the joint overshoots")
RANGE_BEYOND_JOINT = Code(
    "range-beyond-joint", "controllers", WARNING, "the range of an output is larger than the range of its joint"
)
WRONG_SIGN = Code("wrong-sign", "controllers", WARNING, "the robot turns away from what it sees")


MAX_GAIN = 2.0
"""The largest gain that is not reported.

With a delay of 100 to 200 ms, a loop does not overshoot with a gain of 1.5; with a gain of 3, it overshoots by 46 %.
"""

OPPOSITE = {"left": "right", "right": "left", "up": "down", "down": "up", "forward": "backward", "backward": "forward"}
GROWING_ANGLE_TURNS = {"yaw": "left", "pitch": "down"}
"""The direction in which a joint turns as its angle grows; each key is the end of the name of the joint's role."""


def check(controller: ControllerDefinition, report: DocumentReport, draft: ProjectDraft) -> None:
    """Report gains that overshoot, wrong signs, and outputs beyond the range of a joint."""
    for binding in controller.output_bindings:
        variable = controller.outputs[binding.variable]
        path: NodePath = first(report, (*binding.where, "gain"), binding.where)
        _sense(controller, variable, report)
        _sign(variable, binding, path, report, draft.body)
        _gain(controller, binding, path, report, draft)
        if draft.body and binding.joint in draft.body.joints:
            _limits(controller, variable, binding, report, draft.body)


def _sense(controller: ControllerDefinition, output: Variable, report: DocumentReport) -> None:
    """Report an output whose rules lead away from the direction of its input, according to the names of their terms."""
    for name, variable in controller.inputs.items():
        if not (trend := _trend(controller, variable, output)) or not output.direction:
            continue
        wanted = {output.direction: 1, OPPOSITE[output.direction]: -1}.get(variable.direction, 0)
        if wanted * trend < 0:
            moves = "falls" if wanted > 0 else "rises"
            message = (
                f"the robot turns away from what it sees: `{name}` has `direction: {variable.direction}` and"
                f" `{output.name}` has `direction: {output.direction}`, but `{output.name}` {moves} as `{name}` rises"
            )
            way = OPPOSITE[output.direction]
            hint = f"write `direction: {way}` and reverse the sign of the gain, or swap the conclusions of the rules"
            report(WRONG_SIGN, (*output.where, "direction"), message, hint, key=True,
                 related=[((*variable.where, "direction"), "the direction of the input")])  # fmt: skip


def _trend(controller: ControllerDefinition, variable: Variable, output: Variable) -> int:
    """Return how `output` changes as `variable` rises, according to the rules that relate their terms.

    1 means that `output` rises, -1 that it falls, and 0 that its change is unknown.
    """
    asked, said = ranks(tuple(variable.terms)), ranks(tuple(output.terms))
    pairs = [
        (asked[rule.antecedent.term], said[consequent.term])
        for rule in controller.rules
        for consequent in rule.consequents
        if isinstance(rule.antecedent, Proposition)
        and rule.antecedent.variable == variable.name
        and not (rule.antecedent.hedges or consequent.hedges)
        and consequent.variable == output.name
        and rule.antecedent.term in asked
        and consequent.term in said
    ]
    if len(pairs) < 2:
        return 0
    middle = [sum(column) / len(pairs) for column in zip(*pairs, strict=True)]
    slope = sum((a - middle[0]) * (b - middle[1]) for a, b in pairs)
    return int(slope > 0) - int(slope < 0)


def _sign(
    variable: Variable, binding: OutputBinding, path: NodePath, report: DocumentReport, body: Body | None
) -> None:
    named = body.roles.path(binding.joint) if body else ""
    role = body.roles.joint(named) if body else None
    counts = next((way for kind, way in GROWING_ANGLE_TURNS.items() if named.endswith(kind)), "")
    counts = OPPOSITE.get(counts, "") if role and role.reversed else counts
    wanted = {counts: 1, OPPOSITE.get(counts, ""): -1}.get(variable.direction, 0) if variable.direction else 0
    if wanted * binding.gain < 0:
        message = (
            f"with `gain: {binding.gain:g}`, `{binding.joint}` turns {OPPOSITE[variable.direction]},"
            f" but `{variable.name}` has `direction: {variable.direction}`"
        )
        hint = f"write `gain: {-binding.gain:g}`, or `direction: {OPPOSITE[variable.direction]}`"
        others = [((*variable.where, "direction"), "the direction of the output")]
        report(WRONG_SIGN, path, message, hint, related=others)


def _gain(
    controller: ControllerDefinition,
    binding: OutputBinding,
    path: NodePath,
    report: DocumentReport,
    draft: ProjectDraft,
) -> None:
    if abs(binding.gain) <= MAX_GAIN:
        return
    routes = draft.settings.routes if draft.settings else {}
    late = max((routes[b.route].latency for b in controller.input_bindings if b.route in routes), default=0.0)
    age = f" for an input that is {1000 * late:.0f} ms old" if late else ""
    message = f"a gain of {binding.gain:g} is too high{age}: the joint turns beyond its target"
    report(HIGH_GAIN, path, message, f"write at most {MAX_GAIN:g}; 1.5 is fast and does not overshoot")


def _limits(
    controller: ControllerDefinition, variable: Variable, binding: OutputBinding, report: DocumentReport, body: Body
) -> None:
    joint = body.joints[binding.joint]
    low = joint.minimum if binding.minimum is None else binding.minimum
    high = joint.maximum if binding.maximum is None else binding.maximum
    far = max(abs(variable.minimum), abs(variable.maximum)) * abs(binding.gain) * binding.angle
    if far > high - low:
        most, whole = far / controller.angle, (high - low) / controller.angle
        message = f"`{variable.name}` can request a turn of {most:.3g}, but `{joint.name}` can turn by only {whole:.3g}"
        hint = "reduce the range or the gain, and check the unit"
        report(RANGE_BEYOND_JOINT, (*variable.where, "range"), message, hint)
