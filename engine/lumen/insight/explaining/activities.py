"""Why an action of a `do` has not run though its state is active: the action that the `do` has reached instead."""

from collections.abc import Iterator

from lumen.expressions import Scope
from lumen.expressions.scope import no_draw
from lumen.insight.explaining.conditions import first_false
from lumen.insight.explaining.history import StepHistory
from lumen.insight.explaining.insides import within
from lumen.insight.explaining.names import PlacedDeed
from lumen.insight.explaining.refusals import Reason
from lumen.insight.explaining.words import prefix_of
from lumen.language.actions import AskQuestion, If, Parallel, PlacedAction
from lumen.language.diagnostics import NodePath
from lumen.statechart.compiled_machine import compiled
from lumen.statechart.values import Snapshot, awaited


def unreached(history: StepHistory, deed: PlacedDeed) -> Reason | None:
    """Return why an action of a `do` was not reached; None if its state is inactive or nothing prevented it."""
    last = history.steps[-1]
    inner = within(last.step.snapshot, deed.owner)
    state = deed.state
    if inner is None or (state.path and state.name not in inner.configuration):
        return None
    at = last.step.snapshot.epoch + last.at
    name = prefix_of(deed.owner) + (state.name or deed.machine.id)
    position = inner.doing.get(state.path)
    nth = next(i for i, placed in enumerate(state.do) if deed.where[: len(placed.where)] == placed.where)
    if position is not None and position.place < nth:
        ids = list(awaited(position))
        stands = f"it is at step {position.place + 1} of {len(state.do)} and waits for {', '.join(ids)}"
        text = f"the `do` of {name} has not reached this action: {stands}"
        place = last.place(deed.machine, state.do[position.place].where)
        if nth == position.place + 1 and len(ids) == 1 and ids[0].startswith("d"):
            return Reason("no-event", text, at, place, change={"event": f"done.command.{ids[0]}"})
        return Reason("no-event", text, at, place, note="other actions come before it")
    scope = _scope(deed, inner)
    for condition, wanted in _conditions(state.do, deed.where):
        false = first_false(condition.guard, scope)
        if (false is None) != wanted:
            text = f"the `do` of {name} took the other branch of `if {condition.guard.shown}`"
            place = last.place(deed.machine, condition.guard.where)
            return Reason("guard", text, at, place, false, note="a `do` does not return to a branch that it has passed")
    return None


def _conditions(block: tuple[PlacedAction, ...], where: NodePath) -> Iterator[tuple[If, bool]]:
    """Yield each `if` around the action at `where`, and the value of its guard that leads to the action."""
    for placed in block:
        if where[: len(placed.where)] != placed.where:
            continue
        match placed.action:
            case If(_, then, otherwise) as found:
                yield found, any(where[: len(inner.where)] == inner.where for inner in then)
                yield from _conditions(then + otherwise, where)
            case Parallel(branches) | AskQuestion(otherwise=branches):
                yield from _conditions(branches, where)


def _scope(deed: PlacedDeed, now: Snapshot) -> Scope:
    program, machine = compiled(deed.machine), deed.machine
    node, standing = program.chart.nodes[deed.state.path], program.planner.configuration(now.configuration)
    return Scope(
        now.context, None, node.view(now.language, now.place), standing.known.__contains__, now.at, now.language,
        machine.phrases, machine.answers, now.epoch, now.timezone, machine.lists, no_draw, machine,
    )  # fmt: skip
