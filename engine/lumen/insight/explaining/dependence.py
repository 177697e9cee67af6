"""The earlier inputs on which an outcome depends; without all others, the outcome would have been the same.

The answer can include too many inputs: it contains each input that could have decided, not only those that did.
"""

from collections.abc import Callable, Iterator
from functools import partial

from lumen.expressions import names
from lumen.insight.explaining.history import RecordedStep, StepHistory
from lumen.insight.exploration.expression_uses import of_block, of_transition
from lumen.language.machines import MachineDefinition
from lumen.statechart.command_ids import answer_of, inner_id
from lumen.statechart.values import Snapshot


def needed(history: StepHistory, number: int) -> tuple[int, ...]:
    """Return the numbers of step `number` and of all steps on which it depends, in ascending order."""
    found: set[int] = set()
    left = [number]
    while left:
        one = left.pop()
        if one not in found:
            found.add(one)
            left += directly_needed(history, one)
    return tuple(sorted(found))


def directly_needed(history: StepHistory, number: int) -> Iterator[int]:
    """Yield the steps that set what a step depended on.

    These are its active states, the context that it read, and its timer or command. The first step is 0; a number can
    occur several times.
    """
    one = history.steps[number]
    before, event = one.before, one.step.event
    if before is None:
        return
    for name in before.configuration:
        yield _last(history, number, partial(_enters, name))
    for key in _read(history, number):
        yield _last(history, number, partial(_changes, key))
    if before.history or before.halted:
        yield _last(history, number, lambda step: not step.before or step.before.history != step.step.snapshot.history)
    if event is None:
        return
    if event.sendid:
        id, _ = inner_id(event.sendid)
        yield _last(history, number, lambda step: id in _timers(step.step.snapshot) - _timers(step.before))
    elif answer := answer_of(event):
        started = [n for n in history.started.get(answer.id, ()) if n < number]
        yield started[-1] if started else 0


def _last(history: StepHistory, number: int, made: Callable[[RecordedStep], bool]) -> int:
    """Return the number of the last earlier step for which `made` is true, else 0."""
    return next((n for n in reversed(range(number)) if made(history.steps[n])), 0)


def _enters(state: str, one: RecordedStep) -> bool:
    return state in one.step.entered


def _changes(key: str, one: RecordedStep) -> bool:
    return one.before is None or one.before.context.get(key) != one.step.snapshot.context.get(key)


def _timers(snapshot: Snapshot | None) -> set[str]:
    """Return the ids of all running timers, including those of invoked behaviours."""
    inner = snapshot.invoked.values() if snapshot else ()
    own = (timer.id for timer in snapshot.timers) if snapshot else ()
    return {*own, *(id for child in inner for id in _timers(child.snapshot))}


def _read(history: StepHistory, number: int) -> set[str]:
    """Return the keys of the context that the step's guards, or the actions of its states, read."""
    keys: set[str] = set()
    trace = history.trace(number)
    for moment in trace.moments:
        for group in moment.groups:
            for transition in group:
                for use in of_transition(transition.definition):
                    keys |= names(use.tree).context
    for step in trace.microsteps:
        machine = step.moment.machine.chart.definition
        for name in {*step.exited, *step.entered}:
            keys |= _read_by(machine, name)
    for path in history.steps[number].step.snapshot.doing:
        keys |= _read_by(history.steps[number].machine, history.steps[number].machine.states[path].name)
    return keys


def _read_by(machine: MachineDefinition, name: str) -> set[str]:
    state = next((one for one in machine.states.values() if one.name == name), machine.root)
    uses = (use for block in (state.entry, state.do, state.exit) for use in of_block(block))
    return {key for use in uses for key in names(use.tree).context}
