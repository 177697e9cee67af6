"""Rows of `hears` and slots without effect: names that no other row has, and slots that no row reads."""

from collections.abc import Iterator

from lumen.expressions.tree import Literal, walk
from lumen.language.actions import Expression, Template
from lumen.language.diagnostics import WARNING, Code, did_you_mean, nearest
from lumen.language.machines import MachineDefinition, Transition
from lumen.lint.caught import caught_schema, is_broken
from lumen.lint.heard_rows import HeardRows, SaidRow, hearing_behaviors, shown
from lumen.lint.logic import tree
from lumen.lint.naming import heard_rows, read_names, trees
from lumen.lint.walk import expression_sites
from lumen.lint.word_tables import WordTables, known_by, slot_place, word_tables, written_phrases
from lumen.project.draft import ProjectDraft
from lumen.talk.hearing import HEARD
from lumen.talk.patterns import slots_of

UNHEARD_NAME = Code("unheard-name", "hearing", WARNING, "a row with `not` or `asked` has a name that no other row has")
UNUSED_SLOT = Code("unused-slot", "hearing", WARNING, "no row uses the value of a slot")

Reads = dict[str, dict[int, set[str | None]]]
"""For each behaviour, the names that each row reads from `heard`, by the row's number; None means any name."""

_NO_SLOTS = frozenset(("text", "phrase", "answer"))


def check(draft: ProjectDraft) -> None:
    """Report rows with `not` or `asked` whose names no other row has, and slots that no row reads."""
    hearing = hearing_behaviors(draft)
    for name in hearing:
        rows = HeardRows(draft, name)
        for row in rows:
            if row.hears.way in ("not", "asked"):
                _unheard(rows, row)
    reads = {name: _reads(draft.behaviors[name]) for name in hearing}
    for tables in word_tables(draft) if hearing else ():
        for name in (*tables.phrases, *tables.answers):
            _unread(draft, tables, name, reads)


def _unheard(rows: HeardRows, row: SaidRow) -> None:
    """Report the names of a row with `not` or `asked` that no other row of its state or of an ancestor has."""
    around = [*rows.around(row.state.path)]
    others = [other.hears for state in around for other in rows.by_state.get(state.path, ())]
    heard = {name for other in others if not other.way for name in other.names}
    asked = {text for state in around for transition in state.transitions for text in _quoted(transition)}
    for name in row.hears.names:
        if name not in heard | asked:
            message = f"`{row.hears.key}` needs a row `{name}` in {shown(row.state)} or around it"
            hint = did_you_mean(name, heard) if nearest(name, heard) else f"add a row `{name}`, or delete this one"
            rows.report(UNHEARD_NAME, row.path, message, hint, key=True)


def _quoted(transition: Transition) -> Iterator[str]:
    """Yield the texts in a guard under `on` that can be names of phrases."""
    if transition.guard and not transition.hears:
        nodes = (node for node, _ in walk(tree(transition.guard.source)))
        yield from (node.value for node in nodes if isinstance(node, Literal) and isinstance(node.value, str))


def _reads(machine: MachineDefinition) -> dict[int, set[str | None]]:
    found: dict[int, set[str | None]] = {}
    for site in expression_sites(machine):
        row = site.transition.hears if site.transition else None
        if row and HEARD in site.text.shown:
            written = Expression(site.text.shown) if isinstance(site.text, Expression) else Template(site.text.shown)
            for root in trees(written):
                found.setdefault(row.number, set()).update(read_names(root, HEARD))
    return found


def _unread(draft: ProjectDraft, tables: WordTables, name: str, reads: Reads) -> None:
    """Report each slot in the phrases of a name that no row with the name reads, once, at its first phrase."""
    users = known_by(draft, tables.report)
    if not reads.keys() >= {user for user in users if any(heard_rows(draft.behaviors[user]))}:
        return  # an unreadable behaviour may read the slot
    users = [user for user in users if user in reads]
    rows = [(user, row) for user in users for row in heard_rows(draft.behaviors[user]) if name in row.names]
    read = {key for user, row in rows for key in reads[user].get(row.number, ())}
    known = {key for user, row in rows for key in caught_schema(draft.behaviors[user], row).get("properties", ())}
    if not rows or not read <= known:
        return  # a row reads all of `heard`, or a slot that does not exist and may be misspelt
    paths = [("phrases", name), *(("answers", name, i, "phrases") for i in range(len(tables.answers.get(name, ()))))]
    phrases = (phrase for path in paths for phrase in written_phrases(tables.report, path))
    sound = (p for p in phrases if "{" in p.text and not any(is_broken(draft.behaviors[u], p.text) for u in users))
    slots = ((phrase, slot) for phrase in sound for slot in slots_of(phrase.text))
    for phrase, slot in slots:
        if slot.name not in read | _NO_SLOTS:
            read.add(slot.name)
            message = f"no row with `{name}` uses the value of the slot `{slot.name}`"
            hint = f"use `heard.{slot.name}` in a row, or write the phrase without a slot"
            phrase.report.diagnostics.append(UNUSED_SLOT.at(slot_place(phrase, slot), message, hint))
