"""Phrases tried as examples: each form of a phrase, said alone, must match its own row."""

from collections.abc import Collection
from itertools import islice

from lumen.language.diagnostics import WARNING, Code, NodePath, Related
from lumen.language.machines import Hears, Transition, is_within
from lumen.lint.caught import row_phrases
from lumen.lint.events import hears
from lumen.lint.heard_rows import HeardRows, SaidPhrase, SaidRow, hearing_behaviors, remembered, shown
from lumen.lint.naming import looked_up
from lumen.lint.speech import SHADOWED_ANSWER
from lumen.lint.word_tables import declaring_report
from lumen.project.draft import ProjectDraft
from lumen.talk.hearing import HEARD, Taken, hearing_of
from lumen.talk.sample_sentences import of_row

NEVER_HEARD = Code("never-heard", "hearing", WARNING, "a row of `hears` never matches a sentence")
SHADOWED_PHRASE = Code("shadowed-phrase", "hearing", WARNING, "a phrase matches a different row instead of its own")

MAX_TRIED = 300
"""The maximum number of sentences that are tried to match a row with `not` or `asked`."""


def check(draft: ProjectDraft) -> None:
    """Report phrases that match a row other than their own, rows that no sentence matches, and answers never given."""
    hearing = hearing_behaviors(draft)
    looked = looked_up(draft) if hearing else ()
    for name in hearing:
        remembered(draft, ("examples", name), name, (), looked, _Examples(draft, name, looked).check)


class _Examples(HeardRows):
    """Tries the phrases of one behaviour as examples.

    Tables in `looked` are skipped, because `lookup` in expressions matches by other rules.
    """

    def __init__(self, draft: ProjectDraft, behavior: str, looked: Collection[str]) -> None:
        super().__init__(draft, behavior)
        self.looked = looked

    def check(self) -> None:
        for path, rows in self.by_state.items():
            if hiding := self.hiding(path):
                message = (
                    f"no sentence reaches the rows of {shown(rows[0].state)}: {hiding} handles every sentence first"
                )
                self.report(NEVER_HEARD, rows[0].path[:-1], message, "give that transition a `guard`", key=True)
                continue
            for row in rows:
                match row.hears.way:
                    case "":
                        self.found(row)
                    case "else":
                        self.otherwise(row)
                    case _:
                        self.negated_or_asked(row)
        self.answers()

    def found(self, row: SaidRow) -> None:
        """Report the phrases of a row that match another row; if all of them do, report the row instead."""
        if any("." in name for name in row.hears.names):
            return  # phrases of a list's entry, which is not known here
        taken = dict[object, tuple[SaidPhrase, Taken]]()
        others = {n for other in self.by_state[row.state.path] for n in other.hears.names} - {*row.hears.names}
        reached = False
        for example in self.examples(row.hears.names):
            if reached and not example.written:
                break
            if (found := self.names_in(example.text)) and others.isdisjoint(found):
                reached = True
                continue
            order = self.order(row.state.path, example.text)
            both = (*order.first, *order.late)
            if all(one.number not in row.numbers for one in both):
                continue  # a slot does not match the word that the example has for it
            if taker := self.taker(both, row):
                taken.setdefault(example.written and (example.written.report, example.written.path), (example, taker))
            else:
                reached = True
        if not reached and taken:
            example, taker = next(iter(taken.values()))
            other = self.by_number[taker.number]
            why = f"`{other.hears.key}` matches first, for example for `{example.text}`"
            self.never(row, why, "put this row before that one, or merge the two", other)
        elif not any(row_phrases(self.machine, row.hears)):
            names = " and ".join(f"`{name}`" for name in row.hears.names)
            self.never(row, f"there are no phrases for {names}", "write phrases for each language, or delete the row")
        else:
            for example, taker in taken.values():
                self.shadowed(row, example, taker)
            self.is_within(row)

    def is_within(self, row: SaidRow) -> None:
        """Report phrases of a row that match a row of an inner state."""
        own = set(row.hears.names)
        below = [path for path in self.by_state if is_within(path, row.state.path) and path != row.state.path]
        rivals = {name for path in below for other in self.by_state[path] for name in other.hears.names} - own
        told: set[NodePath] = set()
        for example in self.examples(row.hears.names) if rivals else ():
            if not example.written:
                break
            if rivals.isdisjoint(self.names_in(example.text)) or example.written.path in told:
                continue
            found = ((path, self.found_in(path, example.text)) for path in below)
            there = [path for path, rows in found if rows and self.takes(rows[0], row)]
            takers = (self.taker(self.order(path, example.text).first, row) for path in there)
            for taker in takers:
                if taker and own.isdisjoint(self.by_number[taker.number].hears.names):
                    told.add(example.written.path)
                    self.shadowed(row, example, taker)
                    break

    def shadowed(self, row: SaidRow, example: SaidPhrase, taken: Taken) -> None:
        if example.written is None or taken.find is None:
            return  # the phrase comes with Lumen
        other, words = self.by_number[taken.number], self.words(example.text, taken.find)
        whole = words == example.text
        inner = other.state.path != row.state.path
        message = f"`{example.text}` of `{example.name}` matches the row {other.shown}{' first' if inner else ''}"
        message += "" if whole else f" because of `{words}`"
        if inner:
            hint = f"add `{example.name}` to that row, or remove `{words}` from its phrases"
        elif whole:
            hint = (
                f"delete it from one of the rows, or put `{row.hears.key}` first: of equal matches, the first one wins"
            )
        else:
            hint = f"give this phrase more words, or put `{row.hears.key}` before `{other.hears.key}`"
        report, path = example.written.report, example.written.path
        related = Related(self.report.document.place(other.path, key=True), "it matches this row")
        cause = f"{report.document.file} {path}"
        found = SHADOWED_PHRASE.at(report.document.place(path), message, hint, (related,), cause)
        report.diagnostics.append(found)

    def negated_or_asked(self, row: SaidRow) -> None:
        """Report a row with `not` or `asked` that no sentence made of its phrases can match."""
        tried = list(islice(of_row(self.machine, row.hears, {}), MAX_TRIED))
        if not tried or any(row in self.found_in(row.state.path, text) for text in tried):
            return
        names = " and ".join(f"`{name}`" for name in row.hears.names)
        if row.hears.way == "asked":
            why = f"the phrases of {names} already contain a question word"
        elif self.machine.anyhow.issuperset(row.hears.names):
            why = f"the phrases of {names} match even if they are negated (`anyhow: true`)"
        else:
            why = f"the phrases of {names} already contain a negation"
        self.never(row, why, f"delete this row: `{'|'.join(row.hears.names)}` already matches these sentences")

    def otherwise(self, row: SaidRow) -> None:
        """Report an `else` that gets no sentence, because an outer state or every inner state handles all of them."""
        outer = row.state.path
        for state in [*self.around(outer)][1:]:
            if found := next((t for t in state.transitions if _takes_all(t)), None):
                why = f"`{found.event}` of {shown(state)} handles the remaining sentences first"
                self.never(row, why, "give that transition a `guard`", found)
                return
        leaves = self.leaves(outer)
        if outer not in leaves and leaves and all(self.ends(leaf, outer) for leaf in leaves):
            self.never(row, "every inner state has its own `else`", "delete this `else`, or one of those")

    def ends(self, leaf: str, outer: str) -> bool:
        """Return whether an `else` of `leaf`, or of a state between it and `outer`, handles the remaining sentences."""
        return any(
            t.hears and t.hears.way == "else" and not t.guard
            for state in self.between(leaf, outer)
            for t in state.transitions
        )

    def hiding(self, outer: str) -> str:
        """Return a description of a transition that handles every sentence, if all leaves have one; else empty."""
        takers = [
            next((t for state in self.between(leaf, outer) for t in state.transitions if _takes_all(t)), None)
            for leaf in self.leaves(outer)
        ]
        first = takers[0] if takers else None
        if first is None or None in takers:
            return ""
        return f"`{first.event}` of {shown(self.machine.states[first.source])}"

    def answers(self) -> None:
        """Report rows of answers whose phrases all match other rows of the same table."""
        for name in dict.fromkeys(name for row in self for name in row.hears.names if name in self.machine.answers):
            home = declaring_report(self.draft, self.behavior, "answers", name)
            for number in range(len(self.machine.answers[name]) if home and name not in self.looked else 0):
                assert home
                path: NodePath = ("answers", name, number, "phrases")
                texts = [example.text for example in self.written(home, name, path)]
                rivals = [self.rival(name, number, text) for text in texts]
                if rivals and None not in rivals:
                    first = min(rival for rival in rivals if rival is not None)
                    message = f"this answer is never given: row {first + 1} matches `{texts[0]}` first"
                    related = [(("answers", name, first), "if rows match the same number of words, the first one wins")]
                    home(
                        SHADOWED_ANSWER,
                        path,
                        message,
                        f"put this row before row {first + 1}",
                        key=True,
                        related=related,
                    )

    def rival(self, name: str, number: int, text: str) -> int | None:
        """Return the row of the table that answers a sentence instead of row `number`; None if no other row does."""
        key = name, text
        if key not in self.tried.answers:
            hearing = hearing_of(self.machine)
            find = hearing.best(hearing.read(text), Hears(-1, name, (name,)), set(), {})
            self.tried.answers[key] = find and find.entry.row
        row = self.tried.answers[key]
        return None if row == number else row

    def never(self, row: SaidRow, why: str, hint: str, taker: SaidRow | Transition | None = None) -> None:
        where = taker.path if isinstance(taker, SaidRow) else taker.where if taker else ()
        related = [(where, "this comes first")] if taker else []
        self.report(
            NEVER_HEARD, row.path, f"no sentence reaches the row {row.shown}: {why}", hint, key=True, related=related
        )


def _takes_all(transition: Transition) -> bool:
    """Return whether a transition under `on` handles every sentence that reaches it."""
    heard = not transition.hears and not transition.exact and bool(transition.event) and hears(transition.event, HEARD)
    return heard and transition.guard is None
