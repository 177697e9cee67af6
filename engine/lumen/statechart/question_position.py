"""Where an `ask` of a `do` stands, as the positions that every `do` has."""

from typing import NamedTuple

from lumen.statechart.do_actions import AskedQuestion, CompiledAction, ConditionalAction, ParallelActions
from lumen.statechart.values import Fork, Position, Within, awaited


class QuestionPosition(NamedTuple):
    """Where an `ask` stands: before its answer, its deadline, and the end of what it says; None where that is over."""

    asked: Position | None
    deadline: Position | None
    filler: Position | None
    sentences: tuple[Position | None, ...]

    @property
    def answer(self) -> Fork:
        """What of it is not speech."""
        return Fork((self.asked, self.deadline))

    def without(self, id: str) -> "QuestionPosition":
        """Something has been said."""
        filler, *sentences = (None if id in awaited(one) else one for one in (self.filler, *self.sentences))
        return self._replace(filler=filler, sentences=tuple(sentences))

    def fork(self) -> Fork | None:
        return fork([self.asked, self.deadline, self.filler, *self.sentences])


def asks(actions: tuple[CompiledAction, ...], position: Within, id: str) -> bool:
    """Whether a block that stands there awaits the answer to a question under that id."""
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
    """The position of several things at once, None where all are over."""
    return Fork(tuple(branches)) if any(branch is not None for branch in branches) else None
