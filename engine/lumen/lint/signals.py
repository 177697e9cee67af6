"""Bindings of controllers to fields, context keys and events instead of joints."""

import re
from collections.abc import Mapping, Sequence
from itertools import combinations
from typing import Any

from lumen.expressions import schema_of
from lumen.expressions.expression_findings import UNKNOWN_CONTEXT_KEY, UNKNOWN_FIELD
from lumen.language.commands import Track
from lumen.language.controllers import (
    ContextBinding,
    ContextInput,
    ControllerDefinition,
    InputBinding,
    MessageBinding,
    SignalBinding,
    ThresholdBinding,
    Variable,
    VolumeBinding,
)
from lumen.language.diagnostics import ERROR, WARNING, Code, NodePath, did_you_mean
from lumen.language.routes import Direction
from lumen.lint.events import UNUSED_EVENT, descriptors, hears
from lumen.lint.lookups import first
from lumen.lint.references import WRONG_DIRECTION, known_route
from lumen.lint.walk import action_sites
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft


def field_schema(
    draft: ProjectDraft, report: DocumentReport, path: NodePath, route: str, field: Sequence[str]
) -> Mapping[str, Any] | None:
    """Return the schema of a field of a route's messages; None if it is unknown.

    An unknown route or field is reported at `path`.
    """
    if not known_route(draft, report, path, route) or draft.settings is None:
        return None
    schema: Any = draft.messages.get(draft.settings.routes[route].schema)
    for i, step in enumerate(field):
        fields = schema.get("properties") if isinstance(schema, Mapping) else None
        if not isinstance(fields, Mapping):
            return None
        if step not in fields:
            owner = ".".join((route, *field[:i]))
            hint = did_you_mean(step, fields, f"`{owner}` has")
            report(UNKNOWN_FIELD, path, f"the messages of `{owner}` have no field `{step}`", hint)
            return None
        schema = fields[step]
    return schema if isinstance(schema, Mapping) else None


BOUND_TWICE = Code("bound-twice", "controllers", WARNING, "two controller outputs are bound to the same target")
MISSING_FIELD = Code("missing-field", "controllers", ERROR, "a controller's message lacks a required field")
NO_NUMBER = Code("no-number", "controllers", ERROR, "a controller is bound to something that is not a number")
RANGE_BEYOND_FIELD = Code(
    "range-beyond-field", "controllers", WARNING, "the range of an output is larger than its target allows"
)
THRESHOLD_OUT_OF_RANGE = Code(
    "threshold-out-of-range", "controllers", WARNING, "an output never crosses the threshold that it is bound to"
)
UNIT_MISMATCH = Code(
    "unit-mismatch", "controllers", WARNING, "a variable has a different unit from the field that it is bound to"
)

VOLUME: Mapping[str, Any] = {"type": "number", "minimum": 0, "maximum": 1, "description": "How loud the robot speaks."}

_UNIT = re.compile(r"\[([^\]\s]+)\]")
"""Matches the unit in a field's description: `Nearest echo on the left [m].`"""


def check(draft: ProjectDraft) -> None:
    """Report targets of a controller's bindings that are missing or do not fit."""
    for name, controller in draft.controllers.items():
        report = draft.report("fuzzy", name)
        for source in controller.input_bindings:
            _field(draft, report, controller.inputs.get(source.variable), source)
        for key in controller.context_inputs:
            _context(draft, report, controller.inputs.get(key.variable), key)
        for signal in controller.signals:
            _signal(draft, report, controller, signal)
        _lacks(draft, report, controller)
    _twice(draft)


def _signal(
    draft: ProjectDraft, report: DocumentReport, controller: ControllerDefinition, signal: SignalBinding
) -> None:
    variable = controller.outputs[signal.variable]
    match signal:
        case VolumeBinding():
            _fits(report, variable, signal.where, "the volume", VOLUME)
        case MessageBinding():
            if (found := _field(draft, report, variable, signal)) is not None:
                _fits(report, variable, signal.where, f"`{_said(signal)}`", found)
        case ContextBinding():
            if (found := _context(draft, report, variable, signal)) is not None:
                _fits(report, variable, signal.where, f"`{signal.key}`", found)
        case ThresholdBinding():
            _threshold(draft, report, variable, signal)


def _field(
    draft: ProjectDraft, report: DocumentReport, variable: Variable | None, binding: InputBinding | MessageBinding
) -> Mapping[str, Any] | None:
    """Return the schema of the bound field; None if it is unknown.

    Report a field that is not a number or has a different unit.
    """
    path = first(report, (*binding.where, "message"), binding.where)
    found = field_schema(draft, report, path, binding.route, binding.path)
    if isinstance(binding, MessageBinding):
        _direction(draft, report, path, binding.route)
    if found is None or variable is None:
        return None
    _number(report, path, f"`{_said(binding)}`", found)
    unit = _UNIT.search(str(found.get("description", "")))
    if unit and variable.unit and unit[1] != variable.unit:
        message = f"`{variable.name}` is in {variable.unit}, but `{_said(binding)}` is in {unit[1]}"
        hint = f"write `unit: {unit[1]}`, and convert the range and the terms"
        report(UNIT_MISMATCH, (*variable.where, "unit"), message, hint, related=[(binding.where, "it is bound here")])
    return found


def _context(
    draft: ProjectDraft, report: DocumentReport, variable: Variable | None, binding: ContextInput | ContextBinding
) -> Mapping[str, Any] | None:
    """Return the schema of the bound context key; None if no behaviour declares it.

    An undeclared key is reported, unless an unreadable part of a behaviour could declare it.
    """
    path = (*binding.where, "context")
    declared = {
        key: machine.types.get(key, schema_of(value))
        for machine in draft.behaviors.values()
        for key, value in machine.context.items()
    }
    if binding.key not in declared:
        lost = {name for behavior in draft.names.get("behaviors", ()) for name in _lost(draft, behavior)}
        if draft.behaviors and binding.key not in lost:
            hint = did_you_mean(binding.key, declared, "the behaviours have")
            report(UNKNOWN_CONTEXT_KEY, path, f"no behaviour has `{binding.key}` in its context", hint)
        return None
    found = declared[binding.key]
    if variable is not None:
        _number(report, path, f"`{binding.key}`", found)
    return found


def _lost(draft: ProjectDraft, behavior: str) -> set[str]:
    return draft.report("behaviors", behavior).lost if f"behaviors/{behavior}.yaml" in draft.reports else set()


def _number(report: DocumentReport, path: NodePath, what: str, schema: Mapping[str, Any]) -> None:
    """Report a target that can never hold a number."""
    said = schema.get("type")
    kinds = {str(kind) for kind in (said if isinstance(said, list) else [said])}
    if said is not None and not {"number", "integer"} & kinds and kinds != {"null"}:
        report(
            NO_NUMBER,
            path,
            f"{what} is not a number: its type is {' or '.join(sorted(kinds))}",
            "bind to a field or a key that holds a number",
        )


def _fits(report: DocumentReport, variable: Variable, path: NodePath, what: str, schema: Mapping[str, Any]) -> None:
    """Report a range larger than the output's target accepts."""
    low, high = schema.get("minimum"), schema.get("maximum")
    takes = " to ".join(f"{end:g}" if isinstance(end, int | float) else "any" for end in (low, high))
    if (isinstance(low, int | float) and variable.minimum < low) or (
        isinstance(high, int | float) and variable.maximum > high
    ):
        message = (
            f"`{variable.name}` goes from {variable.minimum:g} to {variable.maximum:g}, but {what} goes from {takes}"
        )
        hint = "narrow the range, and adjust its terms"
        report(RANGE_BEYOND_FIELD, (*variable.where, "range"), message, hint, related=[(path, "it is bound here")])


def _threshold(draft: ProjectDraft, report: DocumentReport, variable: Variable, signal: ThresholdBinding) -> None:
    key = "above" if signal.rising else "below"
    if not variable.minimum < signal.threshold < variable.maximum:
        message = f"`{variable.name}` goes from {variable.minimum:g} to {variable.maximum:g}, so it never crosses"
        report(
            THRESHOLD_OUT_OF_RANGE,
            (*signal.where, key),
            f"{message} {signal.threshold:g}",
            f"write a threshold between {variable.minimum:g} and {variable.maximum:g}",
        )
    machines = draft.behaviors.values()
    whole = all(draft.report("behaviors", name).whole for name in draft.behaviors)
    if machines and whole and not any(hears(d, signal.event) for m in machines for d in descriptors(m)):
        hint = did_you_mean(signal.event, {d for m in machines for d in descriptors(m) if "*" not in d})
        hint = hint if "mean" in hint else "handle it under `on:`, or delete this binding"
        message = f"nothing waits for the event `{signal.event}`"
        report(UNUSED_EVENT, (*signal.where, "event"), message, hint)


def _direction(draft: ProjectDraft, report: DocumentReport, path: NodePath, route: str) -> None:
    row = draft.settings.routes.get(route) if draft.settings else None
    if row and row.direction is Direction.IN:
        message = f"`{route}` is a route for incoming messages"
        report(WRONG_DIRECTION, path, message, "publish on a route with `direction: out`")


def _lacks(draft: ProjectDraft, report: DocumentReport, controller: ControllerDefinition) -> None:
    """Report required fields of a message that no binding sets."""
    messages = [signal for signal in controller.signals if isinstance(signal, MessageBinding)]
    for route in dict.fromkeys(signal.route for signal in messages):
        row = draft.settings.routes.get(route) if draft.settings else None
        schema: Any = draft.messages.get(row.schema) if row else None
        required = schema.get("required") if isinstance(schema, Mapping) else None
        mine = [signal for signal in messages if signal.route == route]
        given = {key for signal in mine for key in (signal.path[0], *signal.body)}
        lacking = [name for name in required if name not in given] if isinstance(required, list) else []
        if lacking:
            message = f"a message of `{route}` must have `{'`, `'.join(map(str, lacking))}`"
            hint = f"write {{message: {_said(mine[0])}, body: {{{lacking[0]}: …}}}}"
            report(MISSING_FIELD, mine[0].where, message, hint)


def _twice(draft: ProjectDraft) -> None:
    """Report two outputs with the same target, in one controller or in two controllers that are never switched off."""
    forever = _never_off(draft)
    bound = [
        (name, signal, target)
        for name, controller in draft.controllers.items()
        for signal in controller.signals
        if (target := _target(signal))
    ]
    for (name, signal, target), (other, later, same) in combinations(bound, 2):
        if target == same and (name == other or {name, other} <= forever):
            whose = "" if name == other else f" of `{name}`"
            message = f"`{later.variable}` and `{signal.variable}`{whose} are both bound to {target}"
            hint = "bind only one of them" if name == other else "bind only one of them, or switch one off with `track`"
            draft.report("fuzzy", other)(BOUND_TWICE, later.where, message, hint, key=True)


def _never_off(draft: ProjectDraft) -> set[str]:
    """Return the controllers that some action switches on and no action switches off."""
    actions = [site.step.action for machine in draft.behaviors.values() for site in action_sites(machine)]
    tracks = [action for action in actions if isinstance(action, Track)]
    return {t.controller for t in tracks if t.on} - {t.controller for t in tracks if not t.on}


def _target(signal: SignalBinding) -> str:
    """Return the target of a signal in words; empty for an event, because several signals can raise the same event.

    Messages with different constants count as different targets.
    """
    match signal:
        case VolumeBinding():
            return "the volume"
        case MessageBinding(body=body):
            return f"`{_said(signal)}`" + (f" with {dict(body)}" if body else "")
        case ContextBinding(key=key):
            return f"`{key}` of the context"
        case ThresholdBinding():
            return ""


def _said(binding: InputBinding | MessageBinding) -> str:
    return ".".join((binding.route, *binding.path))
