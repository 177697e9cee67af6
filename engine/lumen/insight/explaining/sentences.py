"""A sentence in a state, row by row: what was found for each row of `hears`, and the row that is taken."""

from collections.abc import Mapping
from typing import Any, NamedTuple

from lumen.expressions import ExpressionError, Scope, compile_expression, compile_guard
from lumen.language.machines import Hears, MachineDefinition, Transition
from lumen.statechart.chart import CompiledGuard, CompiledTransition, StateNode
from lumen.statechart.compiled_machine import compiled
from lumen.statechart.state_changes import names_of
from lumen.talk.hearing import HEARD, Dropped, hearing_of

_DROPPED: Mapping[Dropped, str] = {
    "": "",
    "negated": "negated",
    "not negated": "not negated",
    "part": "not a whole clause",
    "question": "in a question",
    "no question": "not in a question",
    "refusal": "part of a refusal",
}


class FoundPhrase(NamedTuple):
    """A phrase that was found in a sentence."""

    name: str
    """The name of the phrase as written in the row's key."""
    said: str
    """The words of the phrase as they were said."""
    words: int
    """The number of words in the phrase."""
    alone: bool | None
    """Whether the phrase is a whole clause; None if it need not be one."""
    negated: bool
    """Whether the phrase is negated."""
    asked: bool
    """Whether the phrase is part of a question."""
    dropped: Dropped
    """Why the phrase does not count for its row, regardless of the guard; empty if it counts."""

    @property
    def counts(self) -> bool:
        """Whether the phrase counts for its row, regardless of the guard."""
        return not self.dropped


class ExplainedRow(NamedTuple):
    """A row of `hears`, or another transition that waits for a sentence."""

    transition: Transition
    """The row's transition, or the other transition."""
    state: str
    """The name of the transition's state."""
    found: FoundPhrase | None = None
    """The phrase that counts most, else a phrase that does not count; None if none was found."""
    guard: bool | None = None
    """Whether the guard holds; None if there is no guard, or it is not evaluated."""
    error: str = ""
    """Why the guard has no value; empty if it has one."""
    taken: bool = False
    """Whether the row is taken."""
    caught: Mapping[str, Any] = {}
    """The values of `heard` in the row that is taken."""

    @property
    def key(self) -> str:
        """The key of the row in the file; `on EVENT` for another transition."""
        hears = self.transition.hears
        return hears.key if hears else f"on {self.transition.event}"

    @property
    def slots(self) -> dict[str, Any]:
        """The values of the slots that were caught, and the answer if there is one."""
        return {k: v for k, v in self.caught.items() if k not in ("text", "phrase") and (k, v) != ("answer", None)}

    def because(self, taken: "ExplainedRow | None") -> str:
        """Return why this row is taken or not, empty without a reason; `taken` is the row that is taken, if any."""
        hears, found = self.transition.hears, self.found
        if self.taken:
            return "taken"
        if hears and hears.way != "else":
            if found is None:
                return "not found"
            if not found.counts:
                return _DROPPED[found.dropped]
        if self.error:
            return f"its guard fails: {self.error}"
        if self.guard is False:
            return "its guard is false"
        return f"`{taken.key}` is taken before it" if taken else ""


class ExplainedSentence(NamedTuple):
    """All rows that could match a sentence in a state: inner states first, each with its rows in the file's order."""

    rows: tuple[ExplainedRow, ...]

    @property
    def taken(self) -> ExplainedRow | None:
        """The row that is taken, else None."""
        return next((row for row in self.rows if row.taken), None)


def explained(
    machine: MachineDefinition, path: str, text: str, context: Mapping[str, Any], language: str = ""
) -> ExplainedSentence:
    """Return how a sentence matches the rows of the state at a path, and the rows of the states around it.

    Other regions are ignored, and `In()` is true for these states only.
    """
    return _Sentence(machine, path, text, context, language).explained()


def first_context(machine: MachineDefinition) -> Mapping[str, Any]:
    """Return the initial context; a state with `for` has the first entry of its list."""
    context = dict(machine.context)
    for loop in (state.for_each for state in machine.states.values() if state.for_each):
        try:
            entries = compile_expression(loop.each.source)(Scope(context, lists=machine.lists))
        except ExpressionError:
            continue
        if isinstance(entries, list | tuple) and entries:
            context[loop.key] = {"entry": entries[0], "left": entries[1:]}
    return context


class _Sentence:
    def __init__(
        self, machine: MachineDefinition, path: str, text: str, context: Mapping[str, Any], language: str
    ) -> None:
        self.machine, self.context, self.language = machine, context, language
        self.event = {"name": HEARD, "data": {"result": text}}
        self.hearing = hearing_of(machine)
        self.reading = self.hearing.read(text)
        node = compiled(machine).chart.nodes[path]
        self.line = (node, *node.ancestors)
        self.active = names_of(frozenset(self.line))

    def explained(self) -> ExplainedSentence:
        waiting = [t for node in self.line for t in node.transitions if t.matches(HEARD)]
        taken = self.first(waiting)
        return ExplainedSentence(tuple(self.row(one, one is taken) for one in waiting))

    def first(self, waiting: list[CompiledTransition]) -> CompiledTransition | None:
        """Return the transition that is taken, else None.

        Rows with only slots are tried if no other row is taken, and `else` after those.
        """
        rows = [one for one in waiting if not one.is_otherwise]
        passes = (
            [(one, one.guard) for one in rows],
            [(one, one.late) for one in rows if one.late],
            [(one, one.late) for one in waiting if one.is_otherwise],
        )
        return next((one for each in passes for one, guard in each if self.holds(guard, one.source)[0]), None)

    def row(self, one: CompiledTransition, taken: bool) -> ExplainedRow:
        hears, guard = one.definition.hears, one.definition.guard
        found = self.found(hears) if hears and hears.way != "else" else None
        asks = guard is not None and (found.counts if found else hears is None or hears.way == "else")
        holds, error = self.holds(compile_guard(guard.source), one.source) if guard and asks else (None, "")
        caught: Mapping[str, Any] = {}
        if taken and hears:
            caught = self.hearing.caught(hears.number, self.event, self.context, self.language)
        return ExplainedRow(one.definition, one.source.name, found, holds, error, taken, caught)

    def found(self, row: Hears) -> FoundPhrase | None:
        """Return the phrase that counts most for a row, else the one with the most words; None if none was found."""
        nearest = self.hearing.nearest(row.number, self.reading.text, self.context)
        if nearest is None:
            return None
        (find, dropped), reading = nearest, self.reading
        alone = reading.is_whole(find) if find.entry.alone else None
        negated, asked = reading.negation(find) is not None, reading.is_asked(find)
        said, name = reading.said(find.start, find.end), _written(row)[find.entry.name]
        return FoundPhrase(name, said, find.strength, alone, negated, asked, dropped)

    def holds(self, guard: CompiledGuard | None, node: StateNode) -> tuple[bool, str]:
        """Return whether a guard is true in its state, and the error if it has no value."""
        if guard is None:
            return True, ""
        machine = self.machine
        scope = Scope(
            self.context, self.event, node.view(self.language, ""), self.active.__contains__, language=self.language,
            phrases=machine.phrases, answers=machine.answers, lists=machine.lists, machine=machine,
        )  # fmt: skip
        try:
            return guard(scope), ""
        except ExpressionError as error:
            return False, str(error)


def _written(row: Hears) -> dict[str, str]:
    """Return the names as written in a row's key, by their full names."""
    words = row.key.split()
    return dict(zip(row.names, "".join(words[bool(row.way) :]).split("|"), strict=True))
