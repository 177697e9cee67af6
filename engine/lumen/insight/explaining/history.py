"""Recorded steps, from which questions are answered."""

from collections.abc import Sequence
from functools import cached_property
from typing import Any, NamedTuple

from lumen.insight.explaining.tracing import Deed, Trace, retaken
from lumen.language.commands import Start
from lumen.language.diagnostics import NodePath, Place
from lumen.language.events import Event
from lumen.language.machines import MachineDefinition
from lumen.language.projects import Project
from lumen.statechart.command_ids import inner_id
from lumen.statechart.values import Snapshot, Step, Timer

OPERATOR_GOTO = "operator.goto"
"""The event of a step that an operator forced, regardless of the guards."""


class RecordedStep(NamedTuple):
    """A step with the machine and the snapshot from which it was taken.

    A step without an event, other than the first, is a reload, which the machine did not decide.
    """

    machine: MachineDefinition
    """The machine that took the step."""
    before: Snapshot | None
    """The snapshot before the step; None for the first step of a run."""
    step: Step
    """The step, with its event, commands and new snapshot."""
    project: Project | None = None
    """The bundle, which has the places in files; None for a machine without a bundle."""

    @property
    def at(self) -> float:
        """When the step was taken, on the exhibition's clock [s]."""
        return self.step.snapshot.at

    @property
    def is_reload(self) -> bool:
        """Whether the step is a reload of the files."""
        return self.step.event is None and self.before is not None

    @property
    def is_decided(self) -> bool:
        """Whether the machine decided the step; taking it again then gives the same result."""
        return not self.is_reload and not (self.step.event and self.step.event.name == OPERATOR_GOTO)

    def place(self, machine: MachineDefinition, where: NodePath) -> Place | None:
        """Return the place in the files of the node at `where` in a machine's document; None if it is unknown."""
        if self.project is None or not where:
            return None
        names = [name for name, other in self.project.behaviors.items() if other is machine]
        names += [name for name, other in self.project.behaviors.items() if other.id == machine.id]
        return self.project.place(f"behaviors/{names[0]}.yaml", where) if names else None


class StepHistory:
    """Recorded steps, oldest first, and the trace of each, which is computed once by taking the step again."""

    def __init__(self, steps: Sequence[RecordedStep]) -> None:
        self.steps = steps
        self._traces: dict[int, Trace] = {}

    def trace(self, number: int) -> Trace:
        """Return the trace of a step by its number; the trace is empty if the machine did not decide the step."""
        if number not in self._traces:
            one = self.steps[number]
            before = one.before or _before_the_first(one)
            self._traces[number] = retaken(one.machine, before, one.step.event) if one.is_decided else Trace()
        return self._traces[number]

    @cached_property
    def started(self) -> dict[str, list[int]]:
        """The numbers of the steps that started a command, by the command's id; ids repeat after a restart."""
        found: dict[str, list[int]] = {}
        for number, one in enumerate(self.steps):
            for command in one.step.commands:
                if isinstance(command, Start):
                    found.setdefault(command.id, []).append(number)
        return found

    def deed(self, number: int, command: Any) -> Deed | None:
        """Return the action that issued a command of that step, else None."""
        return next((deed for deed in self.trace(number).deeds if deed.what == command), None)


def _before_the_first(first: RecordedStep) -> Snapshot:
    after = first.step.snapshot
    return Snapshot(
        frozenset(), first.machine.context, after.at, after.language, epoch=after.epoch, timezone=after.timezone
    )


def ended_timer(before: Snapshot | None, event: Event) -> Timer | None:
    """Return the timer, of any running behaviour, that ended with that event; else None."""
    id, owner = inner_id(event.sendid)
    inner = within(before, owner)
    return next((t for t in inner.timers if (t.id, t.event) == (id, event.name)), None) if inner and id else None


def sets_timer(one: RecordedStep, sendid: str, timer: Timer) -> bool:
    """Return whether a step set that timer."""
    _, owner = inner_id(sendid)
    before, after = within(one.before, owner), within(one.step.snapshot, owner)
    return after is not None and timer in after.timers and (before is None or timer not in before.timers)


def within(snapshot: Snapshot | None, owner: str) -> Snapshot | None:
    """Return the snapshot of the behaviour that runs under the ids `owner`, as in `hint@quiz`; else None."""
    for id in reversed(owner.split("@")) if owner else ():
        child = snapshot.invoked.get(id) if snapshot else None
        snapshot = child.snapshot if child else None
    return snapshot


def machine_within(one: RecordedStep, owner: str) -> MachineDefinition:
    """Return the machine of the behaviour that runs under the ids `owner`, as in `hint@quiz`.

    It is the outermost machine if `owner` is empty. For a behaviour that was not running before the step, it is the
    first one that can be invoked under its id.
    """
    machine, around = one.machine, one.before
    for id in reversed(owner.split("@")) if owner else ():
        behaviors = [i.behavior for s in machine.states.values() for i in s.invoke if i.id == id]
        child = around.invoked.get(id) if around else None
        chosen = machine.invoked_behavior(child.state, id) if child else behaviors[0]
        machine, around = machine.invoked[chosen], child.snapshot if child else None
    return machine
