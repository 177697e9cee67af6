"""Rows of answers that are never given: an earlier guard or an earlier row matches their phrases."""

from collections.abc import Iterator
from typing import NamedTuple

from lumen.expressions.tree import Binary, ExpressionNode, FunctionCall, Literal, walk
from lumen.language.diagnostics import NodePath
from lumen.language.machines import Answer, MachineDefinition, State
from lumen.lint.examples import SHADOWED_PHRASE
from lumen.lint.guards import covers, heard_call
from lumen.lint.logic import tree
from lumen.lint.speech import SHADOWED_ANSWER
from lumen.lint.word_tables import is_taken, word_tables, written_phrases
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft
from lumen.talk.patterns import Form, forms


class Asking(NamedTuple):
    """A lookup of a table in a transition's guard."""

    table: str
    before: tuple[str, ...]
    """The names of the phrases for which the guards of earlier transitions search the same text."""


def check(draft: ProjectDraft) -> None:
    """Report phrases that an earlier row also has, and rows whose phrases all match a guard before each lookup."""
    owners = {
        id(row): (t.report, name, i)
        for t in word_tables(draft)
        for name, rows in t.answers.items()
        for i, row in enumerate(rows)
    }
    for tables in word_tables(draft):
        for name, rows in tables.answers.items():
            _repeated(tables.report, name, len(rows))
    for machine in draft.behaviors.values():
        askings = list(_askings(machine))
        for table in dict.fromkeys(asking.table for asking in askings):
            several = list(dict.fromkeys(asking.before for asking in askings if asking.table == table))
            for row in machine.answers.get(table, ()):
                if id(row) in owners:
                    _taken(machine, row, several, *owners[id(row)])


def _repeated(report: DocumentReport, table: str, rows: int) -> None:
    """Report phrases of a row that an earlier row also has: the first of equal matches wins.

    A row without other phrases is left to the rule that reports answers that are never given.
    """
    first: dict[tuple[str, Form], tuple[int, NodePath]] = {}
    for i in range(rows):
        phrases = list(written_phrases(report, ("answers", table, i, "phrases")))
        found = [[first.setdefault((p.language, form), (i, p.path)) for form in forms(p.text)] for p in phrases]
        repeated = [(p, above) for p, above in zip(phrases, found, strict=True) if all(row < i for row, _ in above)]
        for phrase, above in repeated if len(repeated) < len(phrases) else ():
            row, path = above[0]
            message = f"`{phrase.text}` is also in row {row + 1} of `{table}`, which is tried first"
            report(
                SHADOWED_PHRASE,
                phrase.path,
                message,
                "delete it from one of the two rows",
                related=[(path, "the same phrase")],
            )


def _askings(machine: MachineDefinition) -> Iterator[Asking]:
    for state in machine.states.values():
        yield from _of(state)


def _of(state: State) -> Iterator[Asking]:
    for i, transition in enumerate(state.transitions):
        if transition.guard is None:
            continue
        for text, table in _lookups(tree(transition.guard.source)):
            earlier = [t.guard for t in state.transitions[:i] if t.guard and covers(t, transition)]
            calls = [heard_call(tree(guard.source)) for guard in earlier]
            yield Asking(table, tuple(call.name for call in calls if call and call.text == text))


def _lookups(guard: ExpressionNode) -> Iterator[tuple[ExpressionNode, str]]:
    """Yield the text and the table of each `lookup` in a guard."""
    for node, _ in walk(guard):
        match node:
            case Binary(left=FunctionCall(function="lookup", arguments=(text, Literal(value=str() as table)))):
                yield text, table


def _taken(
    machine: MachineDefinition, row: Answer, several: list[tuple[str, ...]], report: DocumentReport, table: str, i: int
) -> None:
    phrases = [phrase for texts in row.phrases.values() for phrase in texts]
    takers = [_taker(machine, phrase, before) for phrase in phrases for before in several]
    if phrases and takers and all(takers):
        message = f"this answer is never given: `{phrases[0]}` matches the phrases `{takers[0]}`, which are tried first"
        hint = f"put `lookup(…, '{table}')` before `heard(…, '{takers[0]}')`, or use other phrases"
        report(SHADOWED_ANSWER, ("answers", table, i, "phrases"), message, hint, key=True)


def _taker(machine: MachineDefinition, phrase: str, before: tuple[str, ...]) -> str:
    """Return the first name in `before` that has a phrase which matches `phrase`, else empty."""
    return next((name for name in before if is_taken(phrase, machine.phrases.get(name, {}))), "")
