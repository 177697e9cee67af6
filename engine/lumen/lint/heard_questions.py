"""Questions of knowledge/ that match a row of `hears`, and therefore never reach the state that asks."""

from collections.abc import Iterable, Iterator, Sequence
from functools import cached_property

from lumen.language.actions import AskQuestion, PlacedAction, nested
from lumen.language.diagnostics import WARNING, Code, Related
from lumen.language.folders import KNOWLEDGE_FOLDER
from lumen.language.machines import State, StateKind, is_within
from lumen.lint.buttons import together
from lumen.lint.heard_rows import HeardRows, SaidRow, hearing_behaviors, remembered, shown
from lumen.lint.word_tables import WrittenPhrase, declaring_report, written_phrases
from lumen.project.draft import ProjectDraft
from lumen.talk.finder import Find
from lumen.talk.hearing import Taken, hearing_of

SHADOWED_QUESTION = Code(
    "shadowed-question", "hearing", WARNING, "a question in knowledge/ matches a row of `hears`, so it is not answered"
)


def check(draft: ProjectDraft) -> None:
    """Report questions that match a row that does not answer them, in each state whose `else` leads to an `ask`."""
    files = [passage.file for passage in draft.knowledge.values()]
    for name in hearing_behaviors(draft) if files else ():
        remembered(draft, ("heard questions", name), name, files, None, _Questions(draft, name).check)


class _Questions(HeardRows):
    """Tries the questions of knowledge/ in one behaviour."""

    def __init__(self, draft: ProjectDraft, behavior: str) -> None:
        super().__init__(draft, behavior)
        self.names = {path: {n for row in rows for n in row.hears.names} for path, rows in self.by_state.items()}

    @cached_property
    def slots(self) -> frozenset[str]:
        """The names that have a phrase made only of slots."""
        found = self.tried.slots
        if found is None:
            found = frozenset(entry.name for _, entry in hearing_of(self.machine).finder.slots_only)
            self.tried.slots = found
        return found

    def check(self) -> None:
        asking = [row.state for row in self if row.hears.way == "else" and self.asks(row)]
        active = {state.path: self.active_with(state) for state in asking}
        for question in self.known() if asking else ():
            told: dict[str, list[tuple[Find, SaidRow, State]]] = {}
            for state in asking:
                for taken in self.taken(question.text, state, active[state.path]):
                    row = self.by_number[taken.number]
                    if taken.find and not self.answers(row):
                        told.setdefault(taken.find.entry.name, []).append((taken.find, row, state))
            for found in told.values():
                self.say(question, found)

    def known(self) -> Iterator[WrittenPhrase]:
        for name in self.draft.knowledge:
            yield from written_phrases(self.draft.report(KNOWLEDGE_FOLDER, name), ("questions",))

    def active_with(self, state: State) -> list[str]:
        """Return the states with rows that can be active together with this state.

        Their rows are tried before the `else` of this state.
        """
        return [path for path in self.by_state if together(self.machine, state, self.machine.states[path])]

    def taken(self, text: str, state: State, active: Iterable[str]) -> Iterator[Taken]:
        """Yield the rows that match a sentence before the `else` of a state, if a row does not answer it."""
        names = self.names_in(text)
        for path in active:
            if self.names[path].isdisjoint(names) and not (path == state.path and self.slots & self.names[path]):
                continue  # a sentence without these phrases can't match
            if all(self.answers(row) for row in self.found_in(path, text)):
                continue
            order = self.order(path, text)
            if order.first:
                yield order.first[0]
            elif path == state.path and order.late and order.late[0].find:
                yield order.late[0]

    def answers(self, row: SaidRow) -> bool:
        """Return whether a sentence that matches this row gets an answer; True if a guard decides that."""
        guarded = any(t.guard for t in row.candidates)
        return guarded or self.asks(row) or self.machine.answers.keys() >= set(row.hears.names)

    def asks(self, row: SaidRow) -> bool:
        """Return whether a row has an `ask`, or leads to a state that has one."""
        states = (state for t in row.candidates for state in self.entered(t.targets))
        blocks = [*(t.actions for t in row.candidates), *((*state.entry, *state.do) for state in states)]
        return any(_asks(block) for block in blocks)

    def entered(self, targets: Iterable[str]) -> Iterator[State]:
        """Yield the states that are entered with these targets."""
        for path in targets:
            state = self.machine.states[path]
            yield state
            yield from self.entered(state.children if state.kind is StateKind.PARALLEL else state.initial)

    def say(self, question: WrittenPhrase, takers: Sequence[tuple[Find, SaidRow, State]]) -> None:
        find, row, state = takers[0]
        words, name = self.words(question.text, find), find.entry.name
        message = f"this question is not answered in {shown(state)}: `{words}` in it matches the row `{row.hears.key}`"
        message += "" if row.state is state else f" of {shown(row.state)}"
        places = dict.fromkeys(self.report.document.place(row.path, key=True) for _, row, _ in takers)
        related = tuple(Related(place, "it matches this row") for place in places)
        cause = f"{self.report.document.file} {name} {words.casefold()}"
        place = question.report.document.place(question.path)
        found = SHADOWED_QUESTION.at(place, message, self.remedy(question, find, row, state), related, cause)
        question.report.diagnostics.append(found)

    def remedy(self, question: WrittenPhrase, find: Find, row: SaidRow, state: State) -> str:
        """Return the hint for a question that matches a row: add a row `asked NAME`, or change the row's phrase."""
        name, words = find.entry.name, self.words(question.text, find)
        asked = hearing_of(self.machine).read(question.text).is_asked(find)
        if asked and (is_within(row.state.path, state.path) or is_within(state.path, row.state.path)):
            return f"add a row `asked {name}` to {shown(row.state)} with the same target as `else` of {shown(state)}"
        keys = ("phrases", "answers")
        if not any(
            declaring_report(self.draft, self.behavior, k, name) for k in keys if name in getattr(self.machine, k)
        ):
            remedy = f"write your own phrases for `{name}`, without `{words}`: the current ones come with Lumen"
        else:
            remedy = (
                f"give that phrase more words, or end it with a full stop, so that it matches only `{words}` on its own"
            )
        return f"{remedy}; or delete the question if that row is right for it"


def _asks(block: tuple[PlacedAction, ...]) -> bool:
    return any(isinstance(step.action, AskQuestion) for step in nested(block))
