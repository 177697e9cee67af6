"""The position of an `ask`, converted from and to the general positions of a `do`."""

from typing import NamedTuple

from lumen.statechart.do_actions import AskedQuestion, CompiledAction, ConditionalAction, ParallelActions
from lumen.statechart.values import Fork, Position, Within, awaited


class QuestionPosition(NamedTuple):
    """The positions of an `ask`: its answer, deadline, filler and spoken sentences; None for those that have ended."""

    asked: Position | None
    deadline: Position | None
    filler: Position | None
    sentences: tuple[Position | None, ...]

    @property
    def answer(self) -> Fork:
        """Return the part of the position that is not speech."""
        return Fork((self.asked, self.deadline))

    def without(self, id: str) -> "QuestionPosition":
        """Return the position after the speech `id` has ended."""
        filler, *sentences = (None if id in awaited(one) else one for one in (self.filler, *self.sentences))
        return self._replace(filler=filler, sentences=tuple(sentences))

    def fork(self) -> Fork | None:
        """Return the position as a Fork; None if everything has ended."""
        return fork([self.asked, self.deadline, self.filler, *self.sentences])


def asks(actions: tuple[CompiledAction, ...], position: Within, id: str) -> bool:
    """Return True if a block in that position awaits the answer to the question `id`."""
    return _awaits_answer(actions[position.place], position.inner, id)


def _awaits_answer(action: CompiledAction, position: Position | None, id: str) -> bool:
    match action, position:
        case ConditionalAction(), Within(block, _, _):
            return asks(action.block(block), position, id)
        case ParallelActions(branches), Fork(positions):
            return any(_awaits_answer(a, at, id) for a, at in zip(branches, positions, strict=True))
        case AskedQuestion(), Fork((asked, *_)):
            return id in awaited(asked)
        case AskedQuestion(), Within():
            return asks(action.otherwise, position, id)
    return False


def fork(branches: list[Position | None]) -> Fork | None:
    """Return the position of parallel branches; None if all have ended."""
    return Fork(tuple(branches)) if any(branch is not None for branch in branches) else None
