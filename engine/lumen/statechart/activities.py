"""The `do` of active states while it runs: begun after entry, resumed by answers, ended on exit (UML's do activity)."""

from collections.abc import Callable, Iterable, Mapping
from typing import Any

from lumen.language.events import Event
from lumen.statechart.advancing import ActivityContext, ActivityError, Advance, cancel, resumption_of
from lumen.statechart.asking import sentence_of
from lumen.statechart.chart import StateNode
from lumen.statechart.question_position import asks
from lumen.statechart.values import Halted, Within, awaited


class Activities:
    """How far each `do` has come, by the path of its state; `halted` are those that were left before their end."""

    __slots__ = ("halted", "positions")

    def __init__(self, positions: Mapping[str, Within], halted: Mapping[str, Halted]) -> None:
        self.positions, self.halted = positions, halted

    def begin(self, context: ActivityContext, node: StateNode, halted: Halted | None = None) -> None:
        """Begin what a state does while it is active; where it was halted, as the state says of its `resume`."""
        if halted is None:
            self._advance(context, node, lambda advance: advance.block(node.do))
        else:
            self._advance(context, node, lambda advance: advance.again(node, halted.position, halted.at))

    def resume(self, context: ActivityContext, node: StateNode, id: str, result: Any = None) -> None:
        """Go on with the `do` of that state, since what it awaited under that id is over; `result` is what came of it.

        If the `do` ends with that, its state hears the result.
        """
        position = self.positions[node.path]
        self._advance(context, node, lambda advance: advance.resume_block(node.do, position, id), id, result)

    def answer(self, context: ActivityContext, node: StateNode, id: str, data: Any) -> None:
        """Say what somebody answers to the question that the `do` of that state asked under that id; else ignore it."""
        if (sentence := sentence_of(data)) and self.is_question(node, id):
            position = self.positions[node.path]
            self._advance(context, node, lambda advance: advance.resume_block(node.do, position, id, sentence), id)

    def is_question(self, node: StateNode, id: str) -> bool:
        """Whether the `do` of that state awaits the answer to a question under that id."""
        return asks(node.do, self.positions[node.path], id)

    def lose(self, context: ActivityContext, node: StateNode, id: str, reason: str) -> None:
        """Go on with the `do` of that state though the robot has forgotten what it awaits, as its `resume` says."""
        if not resumption_of(node):
            self.fail(context, node, id, reason)
            return
        position = self.positions[node.path]
        cancel(context, [other for other in awaited(position) if other != id])
        self._advance(context, node, lambda advance: advance.again(node, position, context.at))

    def fail(
        self, context: ActivityContext, node: StateNode, id: str | None, reason: str, started: Iterable[str] = ()
    ) -> None:
        """End a `do` that failed: what else it awaits is cancelled, and its state hears why.

        `id` is that of the command that failed, None for an action that takes no time; `started` is what was begun
        since the position that is known.
        """
        pending = (*awaited(self.positions.get(node.path)), *started)
        cancel(context, [other for other in pending if other != id])
        self._place(node.path, None)
        context.raise_event(Event(f"error.do.{node.name}", {"command": id, "reason": reason}, context.at))

    def cancel(self, context: ActivityContext, path: str) -> None:
        """End a `do` whose state is left."""
        cancel(context, list(awaited(self.positions[path])))
        self._place(path, None)

    def halt(self, node: StateNode, at: float) -> None:
        """Note where the `do` of a state that is left stands, where the state says how it is resumed."""
        if resumption_of(node):
            self.halted = {**self.halted, node.path: Halted(self.positions[node.path], at)}

    def forget(self, path: str) -> Halted | None:
        """Where the `do` of a state that is entered again had stood; it is forgotten."""
        found = self.halted.get(path)
        if found:
            self.halted = {other: halted for other, halted in self.halted.items() if other != path}
        return found

    def _advance(
        self,
        context: ActivityContext,
        node: StateNode,
        move: Callable[[Advance], Within | None],
        id: str | None = None,
        result: Any = None,
    ) -> None:
        context.evaluate_in(node)
        advance = Advance(context)
        try:
            position = move(advance)
        except ActivityError as error:
            context.raise_error(error.reason, error.where)
            self.fail(context, node, id, error.reason, advance.started)
            return
        self._place(node.path, position)
        if position is None:
            context.raise_event(Event(f"done.do.{node.name}", result, context.at))

    def _place(self, path: str, position: Within | None) -> None:
        self.positions = placed(self.positions, path, position)


def placed(positions: Mapping[str, Within], path: str, position: Within | None) -> Mapping[str, Within]:
    """These positions, with another one of the `do` of that state, or without any."""
    rest = {p: where for p, where in positions.items() if p != path}
    return {**rest, path: position} if position else rest
