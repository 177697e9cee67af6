"""Where a behaviour stands when its files change, and what of that speaks against going on."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from lumen.insight.migration import carried_state
from lumen.insight.migration.identity import Identity
from lumen.insight.migration.placing import Placement, Unplaced, place
from lumen.insight.migration.verdicts import MigrationDelay, Refusal
from lumen.language.actions import Action, AskQuestion, If, Parallel, PlacedAction, SayText, Wait
from lumen.language.machines import MachineDefinition, StateKind
from lumen.statechart.chart import StateNode
from lumen.statechart.compiled_machine import compiled
from lumen.statechart.values import Awaiting, Fork, Position, Snapshot, Within


def can_continue(before: tuple[PlacedAction, ...], after: tuple[PlacedAction, ...], position: Within) -> bool:
    """Whether a `do` that stands there finds its place again.

    What has been done already must be of the same verbs, and what is being done the same but for its texts and the
    length of a `wait`; what comes later may be anything.
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
    """The time of the change [s], whether to cancel rather than wait, whether back to a bundle that ran before.

    `languages` are those that may be spoken, the first where the present one is gone; any where there are none.
    `is_invoked` says that another behaviour invoked it.
    """

    at: float
    now: bool = False
    back: bool = False
    languages: Sequence[str] = ()
    is_invoked: bool = False


class Situation:
    """A snapshot between two machines; `placement` is what stays of it, or for whom there is no place."""

    def __init__(
        self, old: MachineDefinition, new: MachineDefinition, snapshot: Snapshot, options: MigrationOptions
    ) -> None:
        self.old, self.new, self.options = compiled(old), compiled(new), options
        self.snapshot = snapshot._replace(at=max(snapshot.at, options.at))
        self.start = self.old.planner.configuration(snapshot.configuration)
        self.identity = Identity(old, new, back=options.back)
        history = carried_state.history(snapshot.history, self.new.chart, self.identity)
        self.placement = place(self.new.chart, self.start.nodes, self.identity, history)

    def refusal(self, unplaced: Unplaced, behavior: str) -> Refusal:
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
        """Whether the new machine is at its end, too, where the old one had come to its own."""
        if isinstance(self.placement, Unplaced) or self.placement.left or self.placement.entered:
            return False
        names = frozenset(node.name for node in self.placement.kept.values() if node.path)
        return self.new.planner.configuration(names).finished

    def ended_elsewhere(self, behavior: str) -> Refusal:
        """Why a behaviour that is over does not go on: a reload brings nothing to life."""
        ends = ", ".join(f"`{node.name}`" for node in self.start.ordered if node.kind is StateKind.FINAL)
        reason = f"the behaviour has ended in {ends}, but in the new files it does not end there"
        return Refusal(
            reason,
            "restart the exhibition: a reload does not start a behaviour that has ended",
            ends.strip("`"),
            behavior,
        )

    def busy(self) -> MigrationDelay | None:
        """The first state that is gone and still does something: it may lead elsewhere by itself."""
        gone = [node for node in self.start.ordered if node.path and self.identity.state(node.path) is None]
        return next((_gone(node) for node in gone if node.path in self.snapshot.doing), None)

    def delays(self, placement: Placement) -> Iterator[MigrationDelay]:
        """What is under way and could not go on, in the order of the old file."""
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
        """The states that stay, and whose `do` is under way and can't go on."""
        doing = [(node, image) for node, image in placement.kept.items() if node.path in self.snapshot.doing]
        return [
            node
            for node, image in doing
            if node.state and image.state
            if not can_continue(node.state.do, image.state.do, self.snapshot.doing[node.path])
        ]

    def ending(self, placement: Placement) -> list[str]:
        """The ids of invoked behaviours that end: their state is left, or invokes another one now."""
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
    """Whether any `do` is under way in a behaviour or in what it has invoked."""
    return bool(snapshot.doing) or any(_is_busy(child.snapshot) for child in snapshot.invoked.values())
