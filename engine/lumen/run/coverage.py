"""The coverage of several runs: the states, transitions and skills that they used, and those that they did not."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

from lumen.language.commands import Command, Do, Start
from lumen.language.diagnostics import NodePath, Place
from lumen.language.machines import MachineDefinition, State, StateKind, Transition
from lumen.language.projects import Project
from lumen.run.loop import Observer
from lumen.statechart import Step
from lumen.statechart.nesting import behavior_of


class Gap(NamedTuple):
    """A state that was never entered, a transition that was never taken, or a skill that was never used."""

    place: Place
    what: str
    """The gap in words."""


@dataclass
class Coverage:
    """The states, transitions and skills that a number of runs covered."""

    project: Project
    entered: dict[str, set[str]] = field(default_factory=dict)
    """Names of the entered states, by behaviour."""
    taken: dict[str, set[NodePath]] = field(default_factory=dict)
    """Paths of the taken transitions, by behaviour."""
    used: set[str] = field(default_factory=set)
    """Names of the skills used."""

    def of(self, behavior: str) -> Observer:
        """Return an observer that records the steps and skills of one run of a behaviour."""
        return _Watcher(self, behavior)

    def note(self, behavior: str, step: Step) -> None:
        """Record a step of a behaviour, and the steps of invoked behaviours that it contains."""
        self.entered.setdefault(behavior, set()).update(step.entered)
        self.taken.setdefault(behavior, set()).update(t.where for t in step.transitions)
        for id, inner in step.invoked:
            self.note(behavior_of(self.project.behaviors[behavior], id, inner), inner)

    @property
    def states(self) -> tuple[int, int]:
        """The number of entered states, and of all states, in the behaviours that ran."""
        wanted = [(b, s.name) for b in self.entered for s in _states(self.project.behaviors[b])]
        return sum(name in self.entered[b] for b, name in wanted), len(wanted)

    @property
    def transitions(self) -> tuple[int, int]:
        """The number of taken transitions, and of all transitions, in the behaviours that ran."""
        wanted = [(b, t.where) for b in self.entered for t in _transitions(self.project.behaviors[b])]
        return sum(where in self.taken[b] for b, where in wanted), len(wanted)

    @property
    def skills(self) -> tuple[int, int]:
        """The number of the project's own skills that were used, and of all of them."""
        return len(self.used.intersection(self.project.verbs)), len(self.project.verbs)

    @property
    def counts(self) -> dict[str, tuple[int, int]]:
        """Numbers of covered items and of all items, by kind; `skills` only in a project that has some."""
        counts = {"states": self.states, "transitions": self.transitions}
        return {**counts, "skills": self.skills} if self.project.verbs else counts

    @property
    def percent(self) -> float:
        """The lowest coverage of any kind [%]; a kind without items counts as 100."""
        return min(100.0 * some / every if every else 100.0 for some, every in self.counts.values())

    def gaps(self) -> list[Gap]:
        """Return the uncovered items, sorted by file and line."""
        unused = (
            Gap(Place(f"skills/{name}.yaml"), f"skill `{name}` is never used")
            for name in self.project.verbs
            if name not in self.used
        )
        return sorted([*unused, *(gap for behavior in self.entered for gap in self._gaps(behavior))])

    def use(self, command: Command) -> None:
        """Count the skill, if any, of a command that a run is about to perform."""
        match command:
            case Start(_, Do(skill)):
                self.used.add(skill)

    def _gaps(self, behavior: str) -> Iterator[Gap]:
        machine, file = self.project.behaviors[behavior], f"behaviors/{behavior}.yaml"
        for state in _states(machine):
            if state.name not in self.entered[behavior]:
                yield Gap(self.project.place(file, state.where), f"state `{state.name}` is never entered")
        for transition in _transitions(machine):
            if transition.where not in self.taken[behavior]:
                place = self.project.place(file, transition.where)
                yield Gap(place, f"{described(machine, transition)} is never taken")


class _Watcher(Observer):
    def __init__(self, coverage: Coverage, behavior: str) -> None:
        self._coverage, self._behavior = coverage, behavior

    def stepped(self, step: Step) -> None:
        self._coverage.note(self._behavior, step)

    def performing(self, command: Command, now: float) -> None:
        self._coverage.use(command)


def described(machine: MachineDefinition, transition: Transition) -> str:
    """Return a transition in words, as in "`ask_name` on `heard`, as GUARD, to `offer`"."""
    source = machine.states[transition.source].name
    guard = f", as {transition.guard.shown}" if transition.guard else ""
    names = ", ".join(f"`{machine.states[path].name or machine.id}`" for path in transition.targets)
    return f"`{source or machine.id}` {trigger(transition)}{guard}" + (f", to {names}" if names else "")


def trigger(transition: Transition) -> str:
    """Return the event or time that a transition waits for, in words."""
    if transition.hears:
        return f"on `{transition.hears.title}`"
    if transition.timed:
        return transition.awaited_time
    if transition.exact:
        return "done" if transition.event.startswith("done.") else "failed"
    return f"on `{transition.event}`" if transition.event else "always"


def _states(machine: MachineDefinition) -> Iterator[State]:
    return (s for s in machine.states.values() if s.path and s.kind is not StateKind.HISTORY)


def _transitions(machine: MachineDefinition) -> Iterator[Transition]:
    return (t for state in machine.states.values() for t in state.transitions)
