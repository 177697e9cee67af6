"""Finds the row of `hears` that a state takes for a sentence, and why it does not take the other rows."""

from collections.abc import Iterator, Mapping
from typing import Any, Literal, NamedTuple

from lumen.expressions import Scope
from lumen.insight.explaining.conditions import holds
from lumen.language.machines import Hears, MachineDefinition, Transition
from lumen.talk.finder import Find
from lumen.talk.hearing import Dropped, hearing_of, said_in

RowFate = Literal["taken", "not found", "guard", "better row"] | Dropped
"""Whether a row is taken, and if not, why. `taken` is the best row of its state, even if another state has priority."""
MAX_QUOTED = 80
"""The maximum number of characters of a sentence that are shown."""


class HeardRow(NamedTuple):
    """A row of `hears` and its result for a sentence."""

    transition: Transition
    """The transition of the row."""
    row: Hears
    """The row as written in the file."""
    fate: RowFate
    """Why the row is taken or not."""
    words: str = ""
    """The words of the row's phrase as they were said; empty if no phrase was found."""
    clause: str = ""
    """The part of the sentence that contains the words."""
    name: str = ""
    """The name of the phrase; empty if no phrase was found."""
    strength: int = 0
    """The number of words in the phrase; 0 if no phrase was found."""
    late: bool = False
    """Whether the row is tried only if no state has taken another row."""
    better: Hears | None = None
    """The row that is taken instead, if the fate is `better row`."""
    caught: Mapping[str, Any] = {}
    """The values of `heard` except the text, by their names in expressions."""

    @property
    def why(self) -> str:
        """Why the row is taken or not: `“dance” is negated in “Please don't dance”`; empty if taken without words."""
        words, clause = _quoted(self.words), _quoted(self.clause)
        match self.fate:
            case "taken":
                return f"{words} in {clause}" if self.words else ""
            case "not found":
                return f"none of its phrases occurs in {clause}"
            case "negated":
                return f"{words} is negated in {clause}"
            case "not negated":
                return f"{words} is not negated in {clause}"
            case "part":
                return f"{words} counts only as a whole clause, but is part of {clause}"
            case "question":
                return f"{words} is part of the question {clause}"
            case "no question":
                return f"{words} is not part of a question in {clause}"
            case "refusal":
                return f"{words} refuses something that another row names"
            case "guard":
                found = f"{words} is in {clause}" if self.words else "nothing else was heard"
                return f"{found}, but its guard is false"
        assert self.better is not None
        return f"{self.better.title} goes first"


def heard_rows(machine: MachineDefinition, state: str, scope: Scope) -> tuple[HeardRow, ...]:
    """Return the result of each row of a state for the sentence in the event of `scope`, in the order of the file.

    `state` is a path; guards are evaluated in `scope`.
    """
    return tuple(_rows(machine, state, scope))


def heard_row(machine: MachineDefinition, transition: Transition, scope: Scope) -> HeardRow:
    """Return the result of one row, given by its transition."""
    return next(row for row in heard_rows(machine, transition.source, scope) if row.row is transition.hears)


def _rows(machine: MachineDefinition, state: str, scope: Scope) -> Iterator[HeardRow]:
    rows = [(t, t.hears) for t in machine.states[state].transitions if t.hears]
    if not rows:
        return
    hearing, text = hearing_of(machine), said_in(scope.event)
    order = hearing.order(rows[0][1].number, text, scope.context)
    finds = {one.number: one.find for one in (*order.first, *order.late)}
    late = {one.number for one in order.late}
    true = {row.number for transition, row in rows if row.number in finds and holds(transition.guard, scope)}
    best = next((one.number for one in (*order.first, *order.late) if one.number in true), None)
    better = next((row for _, row in rows if row.number == best), None)
    for transition, row in rows:
        number = row.number
        if number not in finds:
            nearest = hearing.nearest(number, text, scope.context)
            if nearest is None:
                yield HeardRow(transition, row, "not found", clause=text)
            else:
                yield _found(machine, HeardRow(transition, row, nearest[1]), nearest[0], text)
            continue
        fate: RowFate = "taken" if number == best else "guard" if number not in true else "better row"
        one = HeardRow(transition, row, fate, late=number in late, better=better if fate == "better row" else None)
        if find := finds[number]:
            caught = hearing.caught(number, scope.event, scope.context, scope.language)
            values = {f"heard.{k}": value for k, value in caught.items() if k != "text" and value is not None}
            one = _found(machine, one._replace(caught=values), find, text)
        yield one


def _found(machine: MachineDefinition, row: HeardRow, find: Find, text: str) -> HeardRow:
    """Return the row with the words that were found, and the text that explains its fate.

    The text is the whole sentence if the phrase counts, else the clause.
    """
    reading = hearing_of(machine).read(text)
    inside = [i for i, clause in enumerate(reading.clauses) if clause == reading.clauses[find.start]]
    clause = text if row.fate in ("taken", "guard", "better row") else reading.said(inside[0], inside[-1] + 1)
    words = reading.said(find.start, find.end)
    return row._replace(words=words, clause=clause, name=find.entry.name, strength=find.strength)


def _quoted(text: str) -> str:
    return f"“{text if len(text) <= MAX_QUOTED else f'{text[: MAX_QUOTED - 1]}…'}”"
