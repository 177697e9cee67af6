"""Movements of a robot that an earlier action of the same state put to rest: its motors have no stiffness."""

from collections.abc import Sequence

from lumen.language.actions import PlacedAction, nested
from lumen.language.added_verbs import added_row
from lumen.language.commands import Do, GoTo, Look, Move, Play, Posture, Rest, Wake, Walk
from lumen.language.diagnostics import WARNING, Code
from lumen.language.verbs import verb_of
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft

MOVES_AT_REST = Code(
    "moves-at-rest", "statecharts", WARNING, "a state moves the robot after `rest` and before it wakes it"
)


def check(draft: ProjectDraft) -> None:
    """Report the first action of each state that moves the robot after a `rest` in the same state."""
    for name, machine in draft.behaviors.items():
        report = draft.report("behaviors", name)
        for state in machine.states.values():
            _check((*state.entry, *state.do), report)


def _check(actions: Sequence[PlacedAction], report: DocumentReport) -> None:
    resting = False
    for step in actions:
        inner = [*nested((step,))]
        if any(isinstance(each.action, Wake | Posture) for each in inner):
            resting = False
        elif resting and (moving := next((each for each in inner if _moves(each)), None)):
            verb = verb_of(moving.action).name  # type: ignore[arg-type]
            message = f"the robot rests here, so it can't perform `{verb}`: its motors have no stiffness"
            report(MOVES_AT_REST, (*moving.where, verb), message, "write `wake: true` before it", key=True)
            return
        resting = resting or isinstance(step.action, Rest)


def _moves(step: PlacedAction) -> bool:
    match step.action:
        case Look() | Move() | Walk() | GoTo() | Play():
            return True
        case Do() as command:
            row = added_row(command)
            return row is not None and row.moves
    return False
