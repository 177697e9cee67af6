"""Tactile sensors in guards, as in `event.data.sensor == 'FrontTactil'`, and in `listens` of the ears."""

from collections.abc import Iterator

from lumen.expressions.tree import Binary, ExpressionNode, ListLiteral, Literal, path_of, walk
from lumen.language.diagnostics import NodePath, did_you_mean
from lumen.language.modules import EARS, ModuleSettings
from lumen.language.robots import Body
from lumen.lint.events import hears
from lumen.lint.logic import tree
from lumen.lint.stories import UNKNOWN_SENSOR
from lumen.project.draft import ProjectDraft

_SENSOR = ("event", "data", "sensor")


def check(draft: ProjectDraft) -> None:
    """Report unknown sensors in guards of `touched` and `released`, and in `listens` of the ears."""
    body = draft.body
    if body:
        _ears(draft, body)
    if body is None or not body.tactile:
        return
    for name, machine in draft.behaviors.items():
        report = draft.report("behaviors", name)
        for state in machine.states.values():
            for transition in state.transitions:
                felt = hears(transition.event, "touched") or hears(transition.event, "released")
                if transition.guard and transition.event and felt and report.whole:
                    for sensor in _asked(tree(transition.guard.source)):
                        if sensor not in body.tactile:
                            hint = did_you_mean(sensor, body.tactile, f"{body.name} has")
                            message = f"there is no tactile sensor `{sensor}`"
                            report(UNKNOWN_SENSOR, transition.guard.where, message, hint)


def _ears(draft: ProjectDraft, body: Body) -> None:
    ears = draft.settings.modules.get(EARS, ModuleSettings()) if draft.settings else ModuleSettings()
    touch = ears.options.get("listens", {}).get("touch")
    if draft.main is None or touch is None:
        return
    where: NodePath = ("modules", EARS, "listens", "touch")
    if not body.tactile:
        hint = "delete `touch`, or replace it with `face`"
        draft.main(UNKNOWN_SENSOR, where, f"{body.name} can't feel a touch: it has no tactile sensors", hint)
        return
    for i, sensor in enumerate(touch.get("sensors", ())):
        if sensor not in body.tactile:
            hint = did_you_mean(sensor, body.tactile, f"{body.name} has")
            draft.main(UNKNOWN_SENSOR, (*where, "sensors", i), f"there is no tactile sensor `{sensor}`", hint)


def _asked(guard: ExpressionNode) -> Iterator[str]:
    """Yield the texts with which a guard compares the event's sensor."""
    for node, _ in walk(guard):
        if isinstance(node, Binary) and node.sign in ("==", "!=", "in"):
            for one, other in ((node.left, node.right), (node.right, node.left)):
                if path_of(one) == _SENSOR:
                    for value in other.items if isinstance(other, ListLiteral) else (other,):
                        if isinstance(value, Literal) and isinstance(value.value, str):
                            yield value.value
