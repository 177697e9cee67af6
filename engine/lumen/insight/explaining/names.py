"""The names that a question can use: states, motions and texts of a machine and its invoked behaviours."""

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from lumen.errors import UsageError
from lumen.insight.explaining.history import RecordedStep
from lumen.insight.explaining.words import prefix_of
from lumen.language.actions import Action, AskQuestion, If, Parallel, PlacedAction, SayText
from lumen.language.commands import Play
from lumen.language.diagnostics import NodePath, did_you_mean
from lumen.language.machines import MachineDefinition, State


class PlacedDeed(NamedTuple):
    """An action of a machine and its position."""

    owner: str
    """The ids under which the machine runs; empty for the outermost."""
    machine: MachineDefinition
    """The machine that contains the action."""
    state: State
    """The state that has the action."""
    block: str
    """The block of the state: `entry`, `do` or `exit`; empty for the actions of a transition."""
    action: Action
    """The action."""
    where: NodePath
    """The path of the action in the machine's document."""


def machines_in(machine: MachineDefinition, owner: str = "") -> Iterator[tuple[str, MachineDefinition]]:
    """Yield a machine and its invoked machines, each with the ids under which it runs: `quiz`, `hint@quiz`."""
    yield owner, machine
    for state in machine.states.values():
        for invoke in state.invoke:
            if invoke.behavior in machine.invoked:
                inner = f"{invoke.id}@{owner}" if owner else invoke.id
                yield from machines_in(machine.invoked[invoke.behavior], inner)


def deeds_in(machine: MachineDefinition) -> Iterator[PlacedDeed]:
    """Yield every action of a machine and its invoked behaviours, including those within `if` and `parallel`."""
    for owner, inner in machines_in(machine):
        for state in inner.states.values():
            for name in ("entry", "do", "exit"):
                for action, where in _flat(getattr(state, name)):
                    yield PlacedDeed(owner, inner, state, name, action, where)
            for transition in state.transitions:
                for action, where in _flat(transition.actions):
                    yield PlacedDeed(owner, inner, state, "", action, where)


def _flat(block: tuple[PlacedAction, ...]) -> Iterator[tuple[Action, NodePath]]:
    for placed in block:
        match placed.action:
            case If(_, then, otherwise):
                yield from _flat(then + otherwise)
            case AskQuestion(otherwise=branches) as action:
                yield action, placed.where
                yield from _flat(branches)
            case Parallel(branches):
                yield from _flat(branches)
            case action:
                yield action, placed.where


def same_text(wanted: str, text: str) -> bool:
    """Return whether a text contains these words, ignoring case and punctuation; False without any words."""
    return bool(wanted) and _plain(wanted) in _plain(text)


def _plain(text: str) -> str:
    return " ".join("".join(c for c in text.casefold() if c.isalnum() or c.isspace()).split())


def state_named(machine: MachineDefinition, name: str) -> str:
    """Return the outside name of a state, given by its name, its path or the last part of its path; empty if unknown.

    Raises UsageError if several states match.
    """
    found = [
        (prefix_of(owner), state)
        for owner, inner in machines_in(machine)
        for state in inner.states.values()
        if state.path
    ]
    exact = {prefix + state.name for prefix, state in found if name in (prefix + state.name, prefix + state.path)}
    ends = exact or {prefix + s.name for prefix, s in found if s.path.rpartition(".")[2] == name}
    if len(ends) > 1:
        raise UsageError(f"`{name}` is ambiguous: choose one of {', '.join(f'`{one}`' for one in sorted(ends))}")
    return next(iter(ends), "")


class KnownNames:
    """The names that a question about a recorded step can use."""

    def __init__(self, recorded: RecordedStep) -> None:
        self.machine = recorded.machine
        played = [deed.action.motion for deed in deeds_in(self.machine) if isinstance(deed.action, Play)]
        self.motions = {*played, *(recorded.project.motions if recorded.project else ())}

    def has(self, what: str) -> bool:
        """Return whether `what` is a state, a motion or part of a text."""
        return bool(state_named(self.machine, what)) or what in self.motions or any(self.texts(what))

    def texts(self, what: str) -> Iterable[str]:
        """Yield the texts of the behaviour that contain these words."""
        for deed in deeds_in(self.machine):
            if isinstance(deed.action, SayText):
                yield from (t.text for ts in deed.action.texts.values() for t in ts if same_text(what, t.text))

    def near(self, what: str) -> str:
        """Return a hint with the names most similar to `what`."""
        states = {state.name for _, inner in machines_in(self.machine) for state in inner.states.values() if state.path}
        return did_you_mean(what, sorted(states | self.motions), "there are")
