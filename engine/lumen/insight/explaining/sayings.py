"""Sayings as tests: whether the row that should take each of them does, and catches what it should."""

from collections.abc import Iterable, Iterator, Mapping
from typing import Any, NamedTuple

from lumen.insight.explaining.sentences import ExplainedRow, ExplainedSentence, explained, first_context
from lumen.language.folders import SAYINGS_FOLDER
from lumen.language.machines import MachineDefinition
from lumen.language.sayings import Saying, SayingSet
from lumen.talk.folding import folded
from lumen.talk.hearing import phrases_in


class TriedSaying(NamedTuple):
    """A saying of a `file`, the key of the row that takes it, and what is `wrong`; both empty if there is nothing."""

    file: str
    saying: Saying
    took: str
    wrong: str


def tried(sets: Iterable[SayingSet], machines: Mapping[str, MachineDefinition]) -> Iterator[TriedSaying]:
    """Try the sayings in their states, each with the first values of its behaviour's context."""
    contexts = {name: first_context(machine) for name, machine in machines.items()}
    for each in sets:
        for saying in each.sayings:
            machine = machines[saying.behavior]
            path = path_of(machine, saying.state)
            found = explained(machine, path, saying.text, contexts[saying.behavior], saying.language)
            took = found.taken.key if found.taken else ""
            yield TriedSaying(f"{SAYINGS_FOLDER}/{each.name}.yaml", saying, took, _wrong(saying, found))


def path_of(machine: MachineDefinition, name: str) -> str:
    """Return the path of the state of that id or path; raise KeyError if there is none."""
    found = next((state.path for state in machine.states.values() if name == state.alias), name)
    return machine.states[found].path


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
    """The guards that decided, if one of them did."""
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
    """Whether that was caught; an entry of a list is named by one of its phrases, several answers by one of them."""
    if isinstance(caught, Mapping) and isinstance(wanted, str):
        return any(folded(wanted) == folded(one) for texts in phrases_in(caught).values() for one in texts)
    return bool(caught == wanted or (isinstance(caught, list | tuple) and wanted in caught))


def _shown(value: Any) -> str:
    if value is None:
        return "not caught"
    return f"`{caught_text(value)}`"


def caught_text(value: Any) -> str:
    """Return what a slot caught as text; an entry of a list is named by its first phrase, of several answers each."""
    if isinstance(value, list | tuple):
        return " | ".join(map(str, value))
    texts = [text for several in phrases_in(value).values() for text in several] if isinstance(value, Mapping) else []
    return texts[0] if texts else str(value)
