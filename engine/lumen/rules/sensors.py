"""Sensors of the robot that guards name: `event.data.sensor == 'FrontTactil'`."""

from collections.abc import Iterator

from lumen.interpreters.expressions.tree import Binary, ExpressionNode, ListLiteral, Literal, path_of, walk
from lumen.language.diagnostics import did_you_mean
from lumen.loading.draft import ProjectDraft
from lumen.rules.events import hears
from lumen.rules.logic import tree
from lumen.rules.stories import UNKNOWN_SENSOR

_SENSOR = ("event", "data", "sensor")


def check(draft: ProjectDraft) -> None:
    """Report guards of `touched` and `released` that ask for a sensor which the robot does not have."""
    body = draft.body
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


def _asked(guard: ExpressionNode) -> Iterator[str]:
    """The texts that the event's sensor is compared with."""
    for node, _ in walk(guard):
        if isinstance(node, Binary) and node.sign in ("==", "!=", "in"):
            for one, other in ((node.left, node.right), (node.right, node.left)):
                if path_of(one) == _SENSOR:
                    for value in other.items if isinstance(other, ListLiteral) else (other,):
                        if isinstance(value, Literal) and isinstance(value.value, str):
                            yield value.value
