"""The situation of a behaviour when its files change, and what prevents it from continuing."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from lumen.insight.migration import carried_state
from lumen.insight.migration.placing import Identity, Placement, Unplaced, place
from lumen.insight.migration.verdicts import MigrationDelay, Refusal
from lumen.language.actions import Action, AskQuestion, If, Parallel, PlacedAction, SayText, Wait
from lumen.language.machines import MachineDefinition, StateKind
from lumen.statechart.chart import StateNode
from lumen.statechart.compiled_machine import compiled
from lumen.statechart.values import Awaiting, Fork, Position, Snapshot, Within


def can_continue(before: tuple[PlacedAction, ...], after: tuple[PlacedAction, ...], position: Within) -> bool:
    """Return whether a `do` at that position can continue in the new actions.

    The completed actions must have the same verbs. The current action must be the same, except for texts and the
    length of a `wait`. Later actions can differ.
    """
    place = position.place
    if place >= len(after) or _shape(before[:place]) != _shape(after[:place]):
        return False
    return _same(before[place].action, after[place].action, position.inner)


def _same(before: Action, after: Action, position: Position | None) -> bool:
    match before, after, position:
        case _, _, None:
            return True
        case If(), If(), Within(block):
            return can_continue(_branch(before, block), _branch(after, block), position)
        case AskQuestion(), AskQuestion(), Fork():
            return True
        case AskQuestion(_, _, ours), AskQuestion(_, _, theirs), Within():
            return can_continue(ours, theirs, position)
        case Parallel(ours), Parallel(theirs), Fork(positions):
            if len(ours) != len(theirs):
                return False
            return all(_same(a.action, b.action, p) for a, b, p in zip(ours, theirs, positions, strict=True))
        case (SayText(), SayText(), Awaiting()) | (Wait(), Wait(), Awaiting()):
            return True
    return isinstance(position, Awaiting) and before == after


def _branch(choice: If, block: str) -> tuple[PlacedAction, ...]:
    return choice.then if block == "then" else choice.otherwise


def _shape(steps: tuple[PlacedAction, ...]) -> list[type]:
    return [type(step.action) for step in steps]


class MigrationOptions(NamedTuple):
    """The options of a migration."""

    at: float
    """The time of the change [s]."""
    now: bool = False
    """Whether to cancel each `do` under way instead of waiting for it."""
    back: bool = False
    """Whether the new bundle ran before the old one."""
    languages: Sequence[str] = ()
    """The allowed languages, the first of which replaces a removed language; if empty, any language is allowed."""
    is_invoked: bool = False
    """Whether another behaviour invoked this one."""


class Situation:
    """A snapshot between two machines.

    Raises KeyError if the old machine lacks a state of the snapshot.
    """

    def __init__(
        self, old: MachineDefinition, new: MachineDefinition, snapshot: Snapshot, options: MigrationOptions
    ) -> None:
        self.old, self.new, self.options = compiled(old), compiled(new), options
        self.snapshot = snapshot._replace(at=max(snapshot.at, options.at))
        self.start = self.old.planner.configuration(snapshot.configuration)
        self.identity = Identity(old, new, back=options.back)
        history = carried_state.history(snapshot.history, self.new.chart, self.identity)
        self.placement = place(self.new.chart, self.start.nodes, self.identity, history)
        """The placement of the states, or the state that has no place."""

    def refusal(self, unplaced: Unplaced, behavior: str) -> Refusal:
        """Return the refusal for a state without a place, with a hint on how to fix the file."""
        state, gone, rivals = unplaced
        title = f"`{state.name or behavior}`"
        if len(rivals) > 1:
            *more, last = (f"`{node.name}`" for node in rivals)
            names = f"{', '.join(more)} and {last}"
            reason = f"{names} are active, but can no longer be active together in {title}"
            hint = f"give {title} an `onReload` with the state to go to"
        else:
            reason = f"`{gone.name}` is active but was removed, and no `onReload` names another state"
            hint = f"give {title} an `onReload`, or write the new name of `{gone.path}` under `renamed`"
        return Refusal(reason, hint, gone.name, behavior, state.state.where if state.state else ())

    def still_finished(self) -> bool:
        """Return whether the new machine has ended too, given that the old machine has ended."""
        if isinstance(self.placement, Unplaced) or self.placement.left or self.placement.entered:
            return False
        names = frozenset(node.name for node in self.placement.kept.values() if node.path)
        return self.new.planner.configuration(names).finished

    def ended_elsewhere(self, behavior: str) -> Refusal:
        """Return the refusal for a behaviour that has ended: a reload does not start it again."""
        ends = ", ".join(f"`{node.name}`" for node in self.start.ordered if node.kind is StateKind.FINAL)
        reason = f"the behaviour has ended in {ends}, but in the new files it does not end there"
        return Refusal(
            reason,
            "restart the exhibition: a reload does not start a behaviour that has ended",
            ends.strip("`"),
            behavior,
        )

    def busy(self) -> MigrationDelay | None:
        """Return a delay for the first removed state whose `do` is running; None if there is no such state.

        Such a `do` can still lead to another state.
        """
        gone = [node for node in self.start.ordered if node.path and self.identity.state(node.path) is None]
        return next((_gone(node) for node in gone if node.path in self.snapshot.doing), None)

    def delays(self, placement: Placement) -> Iterator[MigrationDelay]:
        """Yield a delay for each running `do` and invoked behaviour that can't continue, in the old file's order."""
        doing = self.snapshot.doing
        changed = self.changed(placement)
        for node in self.start.ordered:
            if node.path in doing and node in placement.left:
                yield _gone(node)
            elif node in changed:
                yield MigrationDelay(f"these files change the `do` of `{node.name}`, which is still running", node.name)
        for id in self.ending(placement):
            child = self.snapshot.invoked[id]
            if _is_busy(child.snapshot):
                yield MigrationDelay(f"`{id}` is no longer invoked, but is still busy", id)

    def changed(self, placement: Placement) -> list[StateNode]:
        """Return the states that stay, but whose running `do` can't continue."""
        doing = [(node, image) for node, image in placement.kept.items() if node.path in self.snapshot.doing]
        return [
            node
            for node, image in doing
            if node.state and image.state
            if not can_continue(node.state.do, image.state.do, self.snapshot.doing[node.path])
        ]

    def ending(self, placement: Placement) -> list[str]:
        """Return the ids of invoked behaviours that end: their state is left, or now invokes another behaviour."""
        kept = {node.path: image.path for node, image in placement.kept.items()}
        old, new = self.old.chart.definition, self.new.chart.definition
        return [
            id
            for id, child in self.snapshot.invoked.items()
            if child.state not in kept
            or old.invoked_behavior(child.state, id) != new.invoked_behavior(kept[child.state], id)
        ]


def _gone(node: StateNode) -> MigrationDelay:
    return MigrationDelay(f"`{node.name}` is gone, but is still busy", node.name)


def _is_busy(snapshot: Snapshot) -> bool:
    """Return whether a `do` is running in a behaviour or in a behaviour that it has invoked."""
    return bool(snapshot.doing) or any(_is_busy(child.snapshot) for child in snapshot.invoked.values())
