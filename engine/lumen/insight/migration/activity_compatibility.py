"""Whether a `do` that is under way can go on as it is written now."""

from lumen.language.actions import Action, AskQuestion, If, Parallel, PlacedAction, SayText, Wait
from lumen.statechart.values import Awaiting, Fork, Position, Within


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
