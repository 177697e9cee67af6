"""Why a state was not entered or an action has not run: the transitions that lead there, and the `do` before it."""

from collections.abc import Iterator
from typing import NamedTuple

from lumen.expressions import Scope
from lumen.expressions.scope import no_draw
from lumen.insight.explaining.conditions import first_false
from lumen.insight.explaining.history import StepHistory, within
from lumen.insight.explaining.names import PlacedDeed, deeds_in, machines_in, same_text, state_named
from lumen.insight.explaining.refusals import Reason
from lumen.insight.explaining.words import prefix_of
from lumen.language.actions import AskQuestion, If, Parallel, PlacedAction, SayText
from lumen.language.diagnostics import NodePath
from lumen.language.machines import MachineDefinition, StateKind, Transition
from lumen.statechart.compiled_machine import compiled
from lumen.statechart.history import History
from lumen.statechart.state_sets import StateSets
from lumen.statechart.values import Snapshot, awaited


class Way(NamedTuple):
    """A transition that leads to the goal of a question."""

    owner: str
    """The ids under which its behaviour runs; empty for the outermost."""
    machine: MachineDefinition
    transition: Transition
    deed: PlacedDeed | None = None
    """The action to which the transition leads; None if a state is sought."""


def ways(machine: MachineDefinition, what: str) -> list[Way]:
    """Return every transition that leads to `what`; a state has precedence over a motion or a text of that name."""
    if state := state_named(machine, what):
        return list(_into(machine, state))
    found = {id(way.transition): way for deed in deeds(machine, what) for way in _towards(deed)}
    return list(found.values())


def deeds(machine: MachineDefinition, what: str) -> Iterator[PlacedDeed]:
    """Yield the actions that say, play or do `what`."""
    for deed in deeds_in(machine):
        action = deed.action
        if isinstance(action, SayText):
            if any(same_text(what, text.text) for texts in action.texts.values() for text in texts):
                yield deed
        elif what in (
            getattr(action, name) for name in ("motion", "name", "to", "file", "route") if hasattr(action, name)
        ):
            yield deed


def _into(machine: MachineDefinition, state: str) -> Iterator[Way]:
    for owner, inner in machines_in(machine):
        for path, one in inner.states.items():
            if path and prefix_of(owner) + one.name == state:
                yield from (Way(owner, inner, t) for t in entering(inner, path))


def entering(machine: MachineDefinition, path: str) -> Iterator[Transition]:
    """Yield the transitions that enter the state at that path, assuming that no history is remembered."""
    chart = compiled(machine).chart
    nothing: History = {}
    sets = StateSets(chart, nothing)
    for node in chart.nodes.values():
        for transition in node.transitions:
            if transition.targets and chart.nodes[path] in sets.entry_set(sets.domains([transition])):
                yield transition.definition


def _towards(deed: PlacedDeed) -> Iterator[Way]:
    """Yield the transitions after which an action runs."""
    for transition in deed.state.transitions:
        inside = deed.where[: len(transition.where)] == transition.where
        if (not deed.block and inside) or (deed.block == "exit" and transition.targets):
            yield Way(deed.owner, deed.machine, transition, deed)
    if deed.block in ("entry", "do") and deed.state.kind is not StateKind.HISTORY:
        for transition in entering(deed.machine, deed.state.path):
            yield Way(deed.owner, deed.machine, transition, deed)


def unreached(history: StepHistory, deed: PlacedDeed) -> Reason | None:
    """Return why an action of a `do` has not run; None if its state is inactive or nothing is known to prevent it."""
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
