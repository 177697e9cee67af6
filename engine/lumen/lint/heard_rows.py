"""The rows of `hears` of a behaviour, and which of them a sentence matches, for rules that try sentences.

No statechart runs: the rules call `Hearing` directly, state by state.
"""

from collections.abc import Callable, Collection, Hashable, Iterable, Iterator, Mapping, Sequence
from itertools import islice
from typing import NamedTuple

from lumen.language.diagnostics import Diagnostic, NodePath
from lumen.language.machines import Hears, MachineDefinition, State, StateKind, Transition, is_within
from lumen.lint.events import descriptor_path
from lumen.lint.naming import heard_rows
from lumen.lint.word_tables import WrittenPhrase, declaring_report, written_phrases
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft
from lumen.project.memoization import Same, memoize
from lumen.project.project_folders import WORDS_FOLDER
from lumen.talk.finder import Find
from lumen.talk.hearing import RowOrder, Taken, hearing_of
from lumen.talk.sample_sentences import of_phrase

MAX_EXAMPLES = 5_000
"""The maximum number of sentences that are tried for a row, because a file can have very many phrases."""


class SaidRow(NamedTuple):
    """A row of `hears`: its state and its candidates; the first candidate with a true guard is taken."""

    state: State
    candidates: tuple[Transition, ...]

    @property
    def hears(self) -> Hears:
        """The row itself, from its first candidate; all candidates have the same."""
        found = self.candidates[0].hears
        assert found is not None  # they are candidates of a row
        return found

    @property
    def numbers(self) -> frozenset[int]:
        """The numbers of the row in the machine, one for each candidate."""
        return frozenset(t.hears.number for t in self.candidates if t.hears)

    @property
    def path(self) -> NodePath:
        """The path of the row's key in the file."""
        return descriptor_path(self.candidates[0])

    @property
    def shown(self) -> str:
        """The row in the words of a message."""
        return f"`{self.hears.key}` of {shown(self.state)}"


class SaidPhrase(NamedTuple):
    """A form of a phrase as a sentence."""

    text: str
    """The sentence."""
    name: str
    """The name of the phrases or of the table of answers."""
    written: WrittenPhrase | None
    """The phrase in its file; None if it comes with Lumen."""


class TriedSentences:
    """Results for sentences, which depend only on a behaviour's phrases, answers, lists and names that rows hear."""

    def __init__(self) -> None:
        self.names: dict[str, frozenset[str]] = {}
        """By a sentence: the names of the phrases and answers that it contains."""
        self.rows: dict[tuple[tuple[str, ...], str], tuple[str, ...]] = {}
        """By the keys of a state's rows and a sentence: the keys of the rows whose phrases count, in their order."""
        self.answers: dict[tuple[str, str], int | None] = {}
        """By a table of answers and a sentence: the row that answers it; None if no row does."""
        self.slots: frozenset[str] | None = None
        """The names that have a phrase made only of slots; None before they are searched for."""


class HeardRows:
    """The rows of one behaviour by the paths of their states; unreadable rows are left out."""

    def __init__(self, draft: ProjectDraft, behavior: str) -> None:
        self.draft, self.behavior = draft, behavior
        self.machine: MachineDefinition = draft.behaviors[behavior]
        self.report: DocumentReport = draft.report("behaviors", behavior)
        self.by_state = {path: rows for path, state in self.machine.states.items() if (rows := _rows(state))}
        self.by_number = {number: row for row in self for number in row.numbers}
        machine, heard = self.machine, frozenset(name for row in self for name in row.hears.names)
        given = machine.phrases, machine.answers, machine.lists, machine.anyhow, heard
        self.tried = memoize(("tried sentences", behavior), given, TriedSentences)
        """The sentences tried so far, kept from run to run: most edits change neither phrases nor answers."""

    def __iter__(self) -> Iterator[SaidRow]:
        return (row for rows in self.by_state.values() for row in rows)

    def order(self, path: str, text: str) -> RowOrder:
        """Return the rows of the state at that path that a sentence can match, in the order in which they are tried."""
        return hearing_of(self.machine).order(min(self.by_state[path][0].numbers), text, {})

    def names_in(self, text: str) -> frozenset[str]:
        """Return the names of the phrases and answers that a sentence contains."""
        found = self.tried.names.get(text)
        if found is None:
            found = self.tried.names[text] = frozenset(hearing_of(self.machine).read(text).finds)
        return found

    def found_in(self, path: str, text: str) -> list[SaidRow]:
        """Return the rows of the state at that path whose phrases count in a sentence, in the order of `order`."""
        rows = {row.hears.key: row for row in self.by_state[path]}
        keys = self.tried.rows.get((tuple(rows), text))
        if keys is None:
            order = self.order(path, text)
            keys = tuple(self.by_number[one.number].hears.key for one in (*order.first, *order.late) if one.find)
            self.tried.rows[tuple(rows), text] = keys
        return [rows[key] for key in keys]

    def taker(self, taken: Sequence[Taken], row: SaidRow) -> Taken | None:
        """Return the first match if its row takes a sentence from `row`; else None."""
        return taken[0] if taken and self.takes(self.by_number[taken[0].number], row) else None

    def takes(self, other: SaidRow, row: SaidRow) -> bool:
        """Return whether `other` is a row without a guard whose effect differs from that of `row`."""
        return other.numbers.isdisjoint(row.numbers) and not (
            any(t.guard for t in other.candidates) or _alike(other, row)
        )

    def words(self, text: str, find: Find) -> str:
        """Return the words of a sentence in which a phrase was found."""
        return hearing_of(self.machine).read(text).said(find.start, find.end)

    def examples(self, names: Iterable[str]) -> Iterator[SaidPhrase]:
        """Yield every form of the phrases of these names as a sentence, Lumen's own last; at most MAX_EXAMPLES."""
        return islice(self._examples(names), MAX_EXAMPLES)

    def _examples(self, names: Iterable[str]) -> Iterator[SaidPhrase]:
        shipped: list[tuple[str, Mapping[str, tuple[str, ...]]]] = []
        for name in names:
            if name in self.machine.phrases:
                if home := declaring_report(self.draft, self.behavior, "phrases", name):
                    yield from self.written(home, name, ("phrases", name))
                else:
                    shipped.append((name, self.machine.phrases[name]))
            for number in range(len(self.machine.answers.get(name, ()))):
                if home := declaring_report(self.draft, self.behavior, "answers", name):
                    yield from self.written(home, name, ("answers", name, number, "phrases"))
        for name, table in shipped:
            phrases = (phrase for several in table.values() for phrase in several)
            said = (sentence.text for phrase in phrases for sentence in of_phrase(phrase, self.machine.lists))
            yield from (SaidPhrase(text, name, None) for text in said)

    def written(self, home: DocumentReport, name: str, path: NodePath) -> Iterator[SaidPhrase]:
        """Yield every form of the phrases at a path of a file."""
        for written in written_phrases(home, path):
            said = (sentence.text for sentence in of_phrase(written.text, self.machine.lists))
            yield from (SaidPhrase(text, name, written) for text in said)

    def around(self, path: str) -> Iterator[State]:
        """Yield the state at a path and its ancestors, from the inside out."""
        at: str | None = path
        while at is not None:
            yield self.machine.states[at]
            at = self.machine.states[at].parent

    def between(self, leaf: str, outer: str) -> list[State]:
        """Return a state and its ancestors, from the inside out, up to but not including `outer`."""
        return [state for state in self.around(leaf) if is_within(state.path, outer) and state.path != outer]

    def leaves(self, outer: str) -> list[str]:
        """Return the paths of the atomic states in a state; only its own path if it is atomic."""
        states = self.machine.states.values()
        return [state.path for state in states if state.kind is StateKind.ATOMIC and is_within(state.path, outer)]


def hearing_behaviors(draft: ProjectDraft) -> list[str]:
    """Return the behaviours that have rows of `hears` and whose files, including those of words, are free of errors."""
    found = []
    for name, machine in draft.behaviors.items():
        words = [word for word in machine.words if word in draft.own_words]
        known = draft.words.keys() >= set(machine.words)
        reports = [draft.report("behaviors", name), *(draft.report(WORDS_FOLDER, word) for word in words)]
        if known and all(report.whole for report in reports) and any(heard_rows(machine)):
            found.append(name)
    return found


def remembered(
    draft: ProjectDraft, slot: Hashable, behavior: str, other: Collection[str], given: object, find: Callable[[], None]
) -> None:
    """Add the findings of `find` in the files of a behaviour and its words, and in the `other` files.

    If all these files and `given` are the same as in the last call with this `slot`, its findings are reused.
    """
    machine = draft.behaviors[behavior]
    words = [f"{WORDS_FOLDER}/{name}.yaml" for name in machine.words if name in draft.own_words]
    reports = {file: draft.reports[file] for file in (f"behaviors/{behavior}.yaml", *words, *other)}

    def made() -> list[tuple[str, Diagnostic]]:
        before = {file: len(report.diagnostics) for file, report in reports.items()}
        find()
        found = [(file, d) for file, report in reports.items() for d in report.diagnostics[before[file] :]]
        for file, report in reports.items():
            del report.diagnostics[before[file] :]
        return found

    around = Same(machine), [Same(report.document) for report in reports.values()], given
    for file, diagnostic in memoize(slot, around, made):
        reports[file].diagnostics.append(diagnostic)


def shown(state: State) -> str:
    """Return the name of a state for a message."""
    return f"`{state.name}`" if state.path else "the behaviour"


def _rows(state: State) -> tuple[SaidRow, ...]:
    found: dict[str, list[Transition]] = {}
    for transition in state.transitions:
        if transition.hears:
            found.setdefault(transition.hears.key, []).append(transition)
    return tuple(SaidRow(state, tuple(candidates)) for candidates in found.values())


def _alike(one: SaidRow, other: SaidRow) -> bool:
    """Return whether two rows have the same effect."""
    done, instead = ([(t.guard, t.targets, t.actions) for t in row.candidates] for row in (one, other))
    return done == instead
