"""What has happened, as far as it was kept: the material from which questions are answered."""

from collections.abc import Sequence
from functools import cached_property
from typing import Any, NamedTuple

from lumen.insight.explaining.tracing import Deed, Trace, retaken
from lumen.language.commands import Start
from lumen.language.diagnostics import NodePath, Place
from lumen.language.machines import MachineDefinition
from lumen.language.projects import Project
from lumen.statechart.values import Snapshot, Step

OPERATOR_GOTO = "operator.goto"
"""The event of a step that a person wanted, whatever the guards said."""


class RecordedStep(NamedTuple):
    """A step, from where it was taken, and in which machine; `before` is None for the first of a run.

    A step without an event that is not the first is a reload: nothing was decided by the machine. `project` is the
    bundle that says in which files things stand; a machine alone has none.
    """

    machine: MachineDefinition
    before: Snapshot | None
    step: Step
    project: Project | None = None

    @property
    def at(self) -> float:
        """When it was taken, on the exhibition's clock [s]."""
        return self.step.snapshot.at

    @property
    def is_reload(self) -> bool:
        return self.step.event is None and self.before is not None

    @property
    def is_decided(self) -> bool:
        """Whether the machine decided it, so that it can be taken again."""
        return not self.is_reload and not (self.step.event and self.step.event.name == OPERATOR_GOTO)

    def place(self, machine: MachineDefinition, where: NodePath) -> Place | None:
        """Where in the files stands what has that path in the document of a machine; None where nobody knows."""
        if self.project is None or not where:
            return None
        names = [name for name, other in self.project.behaviors.items() if other is machine]
        names += [name for name, other in self.project.behaviors.items() if other.id == machine.id]
        return self.project.place(f"behaviors/{names[0]}.yaml", where) if names else None


class StepHistory:
    """Recorded steps, the oldest first, and what was found out about each by taking it again."""

    def __init__(self, steps: Sequence[RecordedStep]) -> None:
        self.steps = steps
        self._traces: dict[int, Trace] = {}

    def trace(self, number: int) -> Trace:
        """What happened within the step of that number; nothing is known of one that the machine did not decide."""
        if number not in self._traces:
            one = self.steps[number]
            before = one.before or _before_the_first(one)
            self._traces[number] = retaken(one.machine, before, one.step.event) if one.is_decided else Trace()
        return self._traces[number]

    @cached_property
    def started(self) -> dict[str, list[int]]:
        """In which steps a command of that id was started: ids begin anew with each run."""
        found: dict[str, list[int]] = {}
        for number, one in enumerate(self.steps):
            for command in one.step.commands:
                if isinstance(command, Start):
                    found.setdefault(command.id, []).append(number)
        return found

    def deed(self, number: int, command: Any) -> Deed | None:
        """The action that asked for a command of that step."""
        return next((deed for deed in self.trace(number).deeds if deed.what == command), None)


def _before_the_first(first: RecordedStep) -> Snapshot:
    after = first.step.snapshot
    return Snapshot(
        frozenset(), first.machine.context, after.at, after.language, epoch=after.epoch, timezone=after.timezone
    )
