"""Sayings as tests: the right row must take each saying, with the right slots."""

from collections.abc import Iterable, Iterator, Mapping
from typing import Any, NamedTuple

from lumen.insight.explaining.sentences import ExplainedRow, ExplainedSentence, explained, first_context
from lumen.language.folders import SAYINGS_FOLDER
from lumen.language.machines import MachineDefinition, path_of
from lumen.language.sayings import Saying, SayingSet
from lumen.talk.folding import folded
from lumen.talk.hearing import phrases_in


class TriedSaying(NamedTuple):
    """The result of one saying."""

    file: str
    """The file of the saying, relative to the project."""
    saying: Saying
    """The saying, with its expected row and slots."""
    took: str
    """The key of the row that matches it; empty if no row does."""
    wrong: str
    """The difference from the expected result, in words; empty if it is as expected."""


def tried(sets: Iterable[SayingSet], machines: Mapping[str, MachineDefinition]) -> Iterator[TriedSaying]:
    """Yield the result of each saying in its state, with the initial context of its behaviour."""
    contexts = {name: first_context(machine) for name, machine in machines.items()}
    for each in sets:
        for saying in each.sayings:
            machine = machines[saying.behavior]
            path = path_of(machine, saying.state)
            found = explained(machine, path, saying.text, contexts[saying.behavior], saying.language)
            took = found.taken.key if found.taken else ""
            yield TriedSaying(f"{SAYINGS_FOLDER}/{each.name}.yaml", saying, took, _wrong(saying, found))


def _wrong(saying: Saying, found: ExplainedSentence) -> str:
    taken = found.taken
    if taken is None or taken.key != saying.row:
        what = f"`{taken.key}` matches it" if taken else "no row matches it"
        understood = taken is not None and taken.transition.hears and taken.transition.hears.way != "else"
        mend = f"; if `{taken.key}` is right, move this line under `{taken.key}`" if taken and understood else ""
        return f"{what}, but `{saying.row}` should{_by_guard(saying, found)}{mend}"
    missed = [
        f"`{slot}` is {_shown(taken.caught.get(slot))}, but should be `{value}`"
        for slot, value in saying.slots.items()
        if not _same(taken.caught.get(slot), value)
    ]
    return "; ".join(missed)


def _by_guard(saying: Saying, found: ExplainedSentence) -> str:
    """Return the guards that decided, as the end of a sentence; empty if none did."""
    rows = [row for row in found.rows if row.key == saying.row and (row.guard is False or row.error)]
    if rows:
        return f"; {_guard(rows[0])} {'fails' if rows[0].error else 'is false'} with the initial values of the context"
    if found.taken and found.taken.guard:
        return f"; {_guard(found.taken)} is true with the initial values of the context"
    return ""


def _guard(row: ExplainedRow) -> str:
    guard = row.transition.guard
    return f"the guard `{guard.shown}` of `{row.key}`" if guard else ""


def _same(caught: Any, wanted: Any) -> bool:
    """Return whether a slot caught the expected value; one phrase of an entry, or one of several answers, suffices."""
    if isinstance(caught, Mapping) and isinstance(wanted, str):
        return any(folded(wanted) == folded(one) for texts in phrases_in(caught).values() for one in texts)
    return bool(caught == wanted or (isinstance(caught, list | tuple) and wanted in caught))


def _shown(value: Any) -> str:
    if value is None:
        return "not caught"
    return f"`{caught_text(value)}`"


def caught_text(value: Any) -> str:
    """Return a slot's value as text: the first phrase of a list's entry, or all of several answers."""
    if isinstance(value, list | tuple):
        return " | ".join(map(str, value))
    texts = [text for several in phrases_in(value).values() for text in several] if isinstance(value, Mapping) else []
    return texts[0] if texts else str(value)
