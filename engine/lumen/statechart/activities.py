"""The running `do` of active states: begun after entry, resumed by answers, ended on exit (UML's do activity)."""

from collections.abc import Callable, Iterable, Mapping
from typing import Any

from lumen.language.events import Event
from lumen.statechart.advancing import ActivityContext, ActivityError, Advance, cancel, resumption_of
from lumen.statechart.asking import sentence_of
from lumen.statechart.chart import StateNode
from lumen.statechart.question_position import asks
from lumen.statechart.values import Halted, Within, awaited


class Activities:
    """The positions of running `do`, and of `halted` ones that were left before their end, by the path of the state."""

    __slots__ = ("halted", "positions")

    def __init__(self, positions: Mapping[str, Within], halted: Mapping[str, Halted]) -> None:
        self.positions, self.halted = positions, halted

    def begin(self, context: ActivityContext, node: StateNode, halted: Halted | None = None) -> None:
        """Begin the `do` of a state, or resume it from `halted` as the state's `resume` specifies."""
        if halted is None:
            self._advance(context, node, lambda advance: advance.block(node.do))
        else:
            self._advance(context, node, lambda advance: advance.again(node, halted.position, halted.at))

    def resume(self, context: ActivityContext, node: StateNode, id: str, result: Any = None) -> None:
        """Continue the `do` of that state after the command or timer `id` has ended.

        If the `do` ends with it, the event `done.do.*` carries the `result`.
        """
        position = self.positions[node.path]
        self._advance(context, node, lambda advance: advance.resume_block(node.do, position, id), id, result)

    def answer(self, context: ActivityContext, node: StateNode, id: str, data: Any) -> None:
        """Say the answer to the question `id` of that state's `do`; ignore malformed or unexpected data."""
        if (sentence := sentence_of(data)) and self.is_question(node, id):
            position = self.positions[node.path]
            self._advance(context, node, lambda advance: advance.resume_block(node.do, position, id, sentence), id)

    def is_question(self, node: StateNode, id: str) -> bool:
        """Return True if the `do` of that state awaits the answer to the question `id`."""
        return asks(node.do, self.positions[node.path], id)

    def lose(self, context: ActivityContext, node: StateNode, id: str, reason: str) -> None:
        """Continue the `do` of that state as its `resume` specifies, though the robot has forgotten the command `id`.

        Without a `resume` the `do` fails.
        """
        if not resumption_of(node):
            self.fail(context, node, id, reason)
            return
        position = self.positions[node.path]
        cancel(context, [other for other in awaited(position) if other != id])
        self._advance(context, node, lambda advance: advance.again(node, position, context.at))

    def fail(
        self, context: ActivityContext, node: StateNode, id: str | None, reason: str, started: Iterable[str] = ()
    ) -> None:
        """End a `do` that failed: cancel everything else it awaits and raise `error.do.*` with the reason.

        `id` is that of the command that failed, or None for an action that ends at once. `started` are the ids begun
        since the stored position.
        """
        pending = (*awaited(self.positions.get(node.path)), *started)
        cancel(context, [other for other in pending if other != id])
        self._place(node.path, None)
        context.raise_event(Event(f"error.do.{node.name}", {"command": id, "reason": reason}, context.at))

    def cancel(self, context: ActivityContext, path: str) -> None:
        """End the `do` of a state that is left, and cancel everything it awaits."""
        cancel(context, list(awaited(self.positions[path])))
        self._place(path, None)

    def halt(self, node: StateNode, at: float) -> None:
        """Store the position of the `do` of a state that is left at `at` [s], if the state has a `resume`."""
        if resumption_of(node):
            self.halted = {**self.halted, node.path: Halted(self.positions[node.path], at)}

    def forget(self, path: str) -> Halted | None:
        """Remove and return the stored position of the `do` of a state that is entered again; None if there is none."""
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
    """Return the positions with that of one state replaced, or removed if `position` is None."""
    rest = {p: where for p, where in positions.items() if p != path}
    return {**rest, path: position} if position else rest
