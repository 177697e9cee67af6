"""The names that a question may use: states, motions and texts of a machine, and of those that it invokes."""

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
    """An action of a machine: in which state, in which block (empty for those of a transition), and where."""

    owner: str
    machine: MachineDefinition
    state: State
    block: str
    action: Action
    where: NodePath


def machines_in(machine: MachineDefinition, owner: str = "") -> Iterator[tuple[str, MachineDefinition]]:
    """A machine and those that run within it, with the ids under which they do: `quiz`, `hint@quiz`."""
    yield owner, machine
    for state in machine.states.values():
        for invoke in state.invoke:
            if invoke.behavior in machine.invoked:
                inner = f"{invoke.id}@{owner}" if owner else invoke.id
                yield from machines_in(machine.invoked[invoke.behavior], inner)


def deeds_in(machine: MachineDefinition) -> Iterator[PlacedDeed]:
    """Every action, those within `if` and `parallel` included."""
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
    """Whether words are part of a text, however they are written."""
    return bool(wanted) and _plain(wanted) in _plain(text)


def _plain(text: str) -> str:
    return " ".join("".join(c for c in text.casefold() if c.isalnum() or c.isspace()).split())


def state_named(machine: MachineDefinition, name: str) -> str:
    """How `name` is called outside, if it is a state: by its name, its path or the end of one; else nothing.

    Raises UsageError where several end so.
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
    """What can be asked about in the machine, or the bundle, of a recorded step."""

    def __init__(self, recorded: RecordedStep) -> None:
        self.machine = recorded.machine
        played = [deed.action.motion for deed in deeds_in(self.machine) if isinstance(deed.action, Play)]
        self.motions = {*played, *(recorded.project.motions if recorded.project else ())}

    def has(self, what: str) -> bool:
        return bool(state_named(self.machine, what)) or what in self.motions or any(self.texts(what))

    def texts(self, what: str) -> Iterable[str]:
        """Texts of the behaviour in which these words stand."""
        for deed in deeds_in(self.machine):
            if isinstance(deed.action, SayText):
                yield from (t.text for ts in deed.action.texts.values() for t in ts if same_text(what, t.text))

    def near(self, what: str) -> str:
        """What was probably meant."""
        states = {state.name for _, inner in machines_in(self.machine) for state in inner.states.values() if state.path}
        return did_you_mean(what, sorted(states | self.motions), "there are")
